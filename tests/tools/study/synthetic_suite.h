#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "sim/random_stream.h"
#include "tools/study/measured_run.h"

namespace plumbline::testing {

/// How runs of a suite scatter, as standard deviations of logarithms.
struct Scatter {
  double between_seeds = 0.30;  ///< of the 1 s relative error
  double within_pair = 0.06;    ///< of what a change of the estimator does to it besides its mean
};

/// Runs of six scenarios whose 1 s error and end point are scaled.
/// @param change  names the program: the same name is the same program
inline std::vector<MeasuredRun> synthetic_suite(int seeds, const std::string& change, double error_factor = 1.0,
                                                double drift_factor = 1.0, int first_seed = 1, Scatter scatter = {}) {
  std::vector<MeasuredRun> runs;
  for (const char* scenario : {"aggressive", "corridor", "dark", "flat", "tunnel", "vegetated"}) {
    for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
      RandomStream world(static_cast<std::uint64_t>(seed), std::string("world.") + scenario);
      RandomStream own(static_cast<std::uint64_t>(seed), change + scenario);
      const double spread = scatter.between_seeds * world.gaussian() + scatter.within_pair * own.gaussian();
      // Half of an end point is the seed's, half is chance.
      const double x = world.gaussian() + own.gaussian();
      const double y = world.gaussian() + own.gaussian();
      MeasuredRun run;
      run.scenario = scenario;
      run.seed = static_cast<std::uint64_t>(seed);
      run.key = std::to_string(runs.size());
      run.status = "ok";
      run.relative_error_by_second_m.assign(8, 0.008 * error_factor * std::exp(spread));
      run.drift_percent = 0.1 * drift_factor * std::hypot(x, y);
      run.progress_ratio = 1.0 + 0.0007 * drift_factor * x;
      run.estimator_time_ratio = 0.8 * std::exp(0.05 * own.gaussian());
      run.cpu_s = 15.0;
      run.peak_memory_mb = 400.0 * std::exp(0.01 * own.gaussian());
      run.relative_rotation_by_second_deg.assign(8,
                                                 0.02 * error_factor * std::exp(scatter.within_pair * own.gaussian()));
      runs.push_back(run);
    }
  }
  return runs;
}

/// Errors more in every second.
inline void worsen(MeasuredRun& run, double factor) {
  for (double& second : run.relative_error_by_second_m) second *= factor;
}

}  // namespace plumbline::testing
