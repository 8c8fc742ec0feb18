#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/run_rows.h"

namespace plumbline {

/// What a comparison of two programs needs of one run of a suite.
struct MeasuredRun {
  std::string scenario;  ///< its name in the suite
  std::uint64_t seed = 0;
  std::string key;                                      ///< of the run in its study; empty in a baseline
  std::string status;                                   ///< of the result; "error" without one
  std::string reason;                                   ///< why it is not ok
  std::vector<double> relative_error_by_second_m;       ///< of the motions over 1 s that begin in each; NaN: of none
  std::vector<double> relative_rotation_by_second_deg;  ///< likewise, of their rotations
  std::optional<double> drift_percent;
  std::optional<double> progress_ratio;
  /// The estimator's time over the simulation's in the same process, which a slow or busy machine moves little.
  std::optional<double> estimator_time_ratio;
  double cpu_s = 0.0;  ///< of the whole process
  double peak_memory_mb = 0.0;

  bool is_ok() const { return status == "ok"; }
};

/// By scenario, then seed.
bool before_in_suite(const MeasuredRun& a, const MeasuredRun& b);

/// A suite's stored runs, by scenario and seed.
std::vector<MeasuredRun> measured_runs(const SweepPlan& plan, const std::vector<StoredRun>& stored);

}  // namespace plumbline
