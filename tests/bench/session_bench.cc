// A whole run of quickstart with every effect on, by the program itself: simulated over wall seconds, and two threads
// over one. Each run is a process of its own, because Mesa fixes its number of threads once per process.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr char kShortWalk[] = " --set 'motion.waypoints=[[6, 4.75, 1.5], [24, 4.75, 1.5]]'";
constexpr double kWholeWalk_s = 87.56;  ///< duration_s of its result.json

double wall_seconds(const std::string& arguments) {
  const fs::path place = fs::temp_directory_path() / ("plumbline-session-bench-" + std::to_string(getpid()));
  const std::string command = std::string(PLUMBLINE_PROGRAM) + " run " + PLUMBLINE_SCENARIO_DIR "/quickstart.yaml" +
                              arguments + " --out " + place.string() + " >/dev/null 2>&1";
  const auto start = std::chrono::steady_clock::now();
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  fs::remove_all(place);
  return elapsed.count();
}

void BM_QuickstartWithEveryEffect(benchmark::State& state) {
  double wall_s = 0.0;
  for (auto _ : state) wall_s += wall_seconds(" --threads 2");
  state.counters["real_time_factor"] = kWholeWalk_s * static_cast<double>(state.iterations()) / wall_s;
}
BENCHMARK(BM_QuickstartWithEveryEffect)->Unit(benchmark::kSecond)->Iterations(1)->UseRealTime();

void BM_TwoThreadsOverOne(benchmark::State& state) {
  double one = 0.0;
  double two = 0.0;
  for (auto _ : state) {
    one += wall_seconds(std::string(kShortWalk) + " --threads 1");
    two += wall_seconds(std::string(kShortWalk) + " --threads 2");
  }
  state.counters["one_thread_s"] = one / static_cast<double>(state.iterations());
  state.counters["two_threads_s"] = two / static_cast<double>(state.iterations());
  state.counters["times_as_fast"] = one / two;
}
BENCHMARK(BM_TwoThreadsOverOne)->Unit(benchmark::kSecond)->Iterations(2)->UseRealTime();

}  // namespace
}  // namespace plumbline
