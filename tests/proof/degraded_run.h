#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace plumbline {

/// The real estimator, made worse: it keeps 1 - strength of its features in images and scans, its scan matching is
/// coarser and its IMU prior weaker by 1 / (1 - strength). With 0 it is the estimator itself.
struct Degradation {
  double strength = 0.0;      ///< in [0, 1)
  std::filesystem::path out;  ///< where its run goes, as `plumbline run` writes its own
};

/// One simulation, driving the estimator degraded in several ways at once.
struct DegradedRuns {
  std::string scenario;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::uint64_t seed = 1;
  std::vector<Degradation> degradations;  ///< at least one
};

/// @returns the exit code of the first one's run
int make_degraded_runs(const DegradedRuns& runs);

}  // namespace plumbline
