// What moving the rig through MuJoCo's kinematics costs: it grows with the geoms of the world.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

#include "sim/motion.h"
#include "sim/rig_driver.h"
#include "sim/scene_library.h"

namespace plumbline {
namespace {

// An iteration is one simulated second.
void BM_RigDriver(benchmark::State& state, const std::string& scene) {
  const World world = World::from_scene(build_scene(scene, {}, 1), 1);
  MotionConfig motion;
  motion.waypoints = {{{0.0, 0.0, 1.0}, 0.0}, {{1000.0, 0.0, 1.0}, 0.0}};
  const Trajectory trajectory = make_trajectory(motion, 1);
  RigDriver driver(trajectory);
  std::int64_t stamp_ns = 0;
  for (auto _ : state) {
    stamp_ns += 1'000'000'000;
    driver.advance_to(stamp_ns);
    driver.forget_before(stamp_ns);
  }
}
BENCHMARK_CAPTURE(BM_RigDriver, garage, "garage")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_RigDriver, corridor, "corridor")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumbline
