#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace plumbline {

/// One run of the real estimator made worse, written as `plumbline run` writes its own.
struct DegradedRun {
  std::string scenario;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::uint64_t seed = 1;
  std::filesystem::path out;
  /// In [0, 1): the estimator keeps 1 - strength of its features in images and scans, its scan matching is coarser and
  /// its IMU prior weaker by 1 / (1 - strength). With 0 it is the estimator itself.
  double strength = 0.0;
};

/// @returns the program's exit code
int make_degraded_run(const DegradedRun& run);

}  // namespace plumbline
