// A whole session, sensors and estimator, with one thread and with two: simulated over wall seconds, and their ratio.
#include <benchmark/benchmark.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "scenarios/session.h"

namespace plumbline {
namespace {

double wall_seconds(const Scenario& scenario, const World& world, const RayScene& rays, int threads) {
  SessionOptions options;
  options.threads = threads;
  const auto start = std::chrono::steady_clock::now();
  const RunRecord record = run_session(scenario, world, rays, options);
  benchmark::DoNotOptimize(record.estimate.data());
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void BM_TwoThreadsOverOne(benchmark::State& state) {
  const auto path = std::filesystem::path(PLUMBLINE_SCENARIO_DIR) / "quickstart.yaml";
  const Scenario scenario = load_scenario(path, {"motion.waypoints=[[6, 4.75, 1.5], [24, 4.75, 1.5]]"}, std::nullopt);
  const World world = make_world(scenario);
  const RayScene rays(world);
  double one = 0.0;
  double two = 0.0;
  for (auto _ : state) {
    one += wall_seconds(scenario, world, rays, 1);
    two += wall_seconds(scenario, world, rays, 2);
  }
  state.counters["one_thread_s"] = one / static_cast<double>(state.iterations());
  state.counters["two_threads_s"] = two / static_cast<double>(state.iterations());
  state.counters["times_as_fast"] = one / two;
}
BENCHMARK(BM_TwoThreadsOverOne)->Unit(benchmark::kSecond)->Iterations(2)->UseRealTime();

}  // namespace
}  // namespace plumbline
