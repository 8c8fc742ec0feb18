#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/study/study_keys.h"

namespace plumbline {

/// A value that a key of the scenario takes.
struct AxisValue {
  std::string text;              ///< YAML on one line, as after `--set KEY=`
  std::optional<double> number;  ///< if it is one
};

/// A place in a range, to six digits: readable, and free of the last bit's noise that 0.1 + 0.2 has.
AxisValue rounded_value(double number);

/// A key of the scenario and what it ranges over.
struct SweepAxis {
  std::string key;
  bool logarithmic = false;
  std::vector<AxisValue> values;                   ///< ascending if they are numbers; empty where sampled
  std::optional<std::pair<double, double>> range;  ///< of a sampled axis

  bool is_sampled() const { return range.has_value(); }
  bool is_numeric() const;
};

struct SweepSample {
  enum class Kind { kLatinHypercube, kSobol };
  Kind kind = Kind::kLatinHypercube;
  std::size_t count = 0;
};

/// A sweep file, read and checked; which runs it makes is the plan's matter.
struct SweepFile {
  std::string name;  ///< the file's stem
  std::filesystem::path path;
  std::filesystem::path scenario;
  std::vector<std::string> fixed;  ///< KEY=VALUE for every run
  std::vector<SweepAxis> axes;     ///< by key
  std::optional<SweepSample> sample;
  std::vector<std::uint64_t> seeds;     ///< ascending; empty: the scenario's own
  std::vector<std::string> estimators;  ///< by name; empty: the scenario's own
  RunLimits limits;
  std::string boundary_axis;           ///< key of the axis whose boundary is sought; empty: every run is made
  std::vector<std::string> detectors;  ///< of degeneracy, to be judged in every run
};

/// Keys: scenario, set {KEY: VALUE}, axes {KEY: [VALUE, ...] | {range: [a, b], count | step} | {log_range: [a, b],
/// count}}, sample {latin_hypercube: N} or {sobol: N} (then ranges have neither count nor step, and lists are crossed
/// with the sample), seeds [N, ...] or a count (1 ... N), estimators [NAME, ...], limits {time_s, memory_mb},
/// find_boundary KEY, detectors [NAME, ...] or `all`.
/// @throws InputError for anything missing, malformed, unknown or twice
SweepFile read_sweep_file(const std::filesystem::path& path);

/// What other studies' files have in common with a sweep's: sample, axes, set, seeds and estimators.
/// @param axes  the key that the axes stand under
void read_runs(ConfigReader& reader, SweepFile& sweep, const std::string& axes = "axes");

}  // namespace plumbline
