// What localization costs a second of data, and what it errs: ours at 0.5 Hz, and the particle filter at 0.5 and 5 Hz
// (thesis Fig. 8.5 and Table 8.1). Odometry drifts by 0.1 % of the way, the thesis's figure for its own.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "tests/estimator/localization_world.h"

namespace plumbline {
namespace {

constexpr double kDuration_s = 30.0;

Pose drift(double t) { return {Eigen::Quaterniond::Identity(), {7e-4 * t, 7e-4 * t, 0.0}}; }

void run(benchmark::State& state, LocalizationMethod method, double rate_hz) {
  const testing::BoxWorld hall = testing::pillared_hall(50.0);
  const PriorMap map = testing::mapped_along_x(hall, 35.0);
  LocalizationConfig config;
  config.method = method;
  config.rate_hz = rate_hz;
  std::vector<double> errors;
  double processing_s = 0.0;
  double matches = 0.0;
  double iterations = 0.0;
  for (auto _ : state) {
    const testing::LocalizedRun result = testing::run_localized(hall, map, testing::stroll, drift, kDuration_s, config);
    for (const Odometry& output : result.outputs) {
      if (output.localized) errors.push_back(testing::position_error(output, testing::stroll));
    }
    for (const MapMatch& match : result.matches) {
      processing_s += match.processing_s;
      iterations += match.iterations;
    }
    matches += static_cast<double>(result.matches.size());
  }
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double share) {
    return errors.empty() ? -1.0 : errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
  };
  state.counters["median_mm"] = 1e3 * at(0.5);
  state.counters["p75_mm"] = 1e3 * at(0.75);
  state.counters["max_mm"] = 1e3 * at(1.0);
  state.counters["ms_a_match"] = 1e3 * processing_s / matches;
  state.counters["ms_a_second"] = 1e3 * processing_s / (static_cast<double>(state.iterations()) * kDuration_s);
  state.counters["iterations"] = iterations / matches;
}

void BM_Matcher(benchmark::State& state) { run(state, LocalizationMethod::kScanMatching, 0.5); }
void BM_ParticleFilter(benchmark::State& state) { run(state, LocalizationMethod::kParticleFilter, 0.5); }
void BM_ParticleFilter5Hz(benchmark::State& state) { run(state, LocalizationMethod::kParticleFilter, 5.0); }
BENCHMARK(BM_Matcher)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(BM_ParticleFilter)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(BM_ParticleFilter5Hz)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace plumbline
