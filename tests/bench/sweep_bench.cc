// The smoke sweep's scenario, one run at a time and two: a sweep's throughput, and their ratio. The program makes the
// runs, so that loading, writing and storing count.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tools/study/sweep_directory.h"
#include "tools/study/sweep_runner.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

double wall_seconds(const SweepFile& sweep, const SweepPlan& plan, int jobs) {
  const fs::path place = fs::temp_directory_path() / ("plumbline-sweep-bench-" + std::to_string(getpid()));
  const auto start = std::chrono::steady_clock::now();
  {
    SweepDirectory directory(place, plan, SweepDirectory::Mode::kNew);
    make_runs(plan, directory, plumbline_run(sweep, plan, PLUMBLINE_PROGRAM), {jobs, {}, {}});
    if (directory.rows().size() != plan.runs.size()) throw std::runtime_error("a run is missing");
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  fs::remove_all(place);
  return elapsed.count();
}

void BM_TwoJobsOverOne(benchmark::State& state) {
  SweepFile sweep = read_sweep_file(fs::path(PLUMBLINE_SCENARIO_DIR) / "sweeps" / "smoke.yaml");
  sweep.estimators = {"vloam"};
  sweep.seeds = {1, 2};
  const SweepPlan plan = make_plan(sweep);
  double one = 0.0;
  double two = 0.0;
  for (auto _ : state) {
    one += wall_seconds(sweep, plan, 1);
    two += wall_seconds(sweep, plan, 2);
  }
  state.counters["runs"] = static_cast<double>(plan.runs.size());
  state.counters["one_job_s"] = one / static_cast<double>(state.iterations());
  state.counters["two_jobs_s"] = two / static_cast<double>(state.iterations());
  state.counters["times_as_fast"] = one / two;
}
BENCHMARK(BM_TwoJobsOverOne)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

}  // namespace
}  // namespace plumbline
