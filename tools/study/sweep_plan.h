#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/sweep_file.h"

namespace plumbline {

/// One run of a sweep.
struct PlannedRun {
  std::string key;                ///< its place in the plan's order, zero-padded: keys sort as text
  std::vector<AxisValue> values;  ///< one per axis
  std::string estimator;
  std::uint64_t seed = 0;
  std::string scenario_digest;  ///< of the resolved scenario, which tells a run made from another file
};

/// Every run that a sweep may make, in one order that does not depend on how the file lists them: by axis values, then
/// estimator, then seed. With a boundary to find, the search makes only some of them.
struct SweepPlan {
  std::string name;
  std::string scenario;  ///< its name
  std::vector<SweepAxis> axes;
  std::optional<SweepSample> sample;
  std::vector<std::string> fixed;
  std::vector<std::string> estimators;
  std::vector<std::uint64_t> seeds;
  RunLimits limits;
  std::string boundary_axis;
  std::vector<std::string> detectors;
  std::string program;  ///< version and commit that make the runs
  std::vector<PlannedRun> runs;

  /// @returns nullptr if there is none
  const PlannedRun* find(const std::string& key) const;
  /// Index of the axis whose boundary is sought.
  std::optional<std::size_t> boundary() const;
};

/// Loads the scenario of every run once, so that nothing is started that cannot be.
/// @throws InputError for a key or value that the scenario refuses, or too many runs
SweepPlan make_plan(const SweepFile& sweep);

/// KEY=VALUE for one run, without its seed and estimator.
std::vector<std::string> overrides_of(const SweepPlan& plan, const PlannedRun& run);

/// "world.light.lux = 10, vloam, seed 3"
std::string describe(const SweepPlan& plan, const PlannedRun& run);

/// The plan as JSON, the same text for the same plan, and back.
std::string plan_json(const SweepPlan& plan);
SweepPlan plan_of_json(const std::string& text);

/// What two plans (as JSON) differ in, for a message; empty if nothing.
std::string plan_difference(const std::string& stored, const std::string& asked);

}  // namespace plumbline
