// What the lidar costs: rays per second against the number of triangles, and a whole scan of the VLP-16.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "sensors/lidar.h"
#include "sim/random_stream.h"
#include "sim/ray_scene.h"

namespace plumbline {
namespace {

// A corridor 4 m wide and 3 m high with boxes of 12 triangles each along its walls.
World corridor(int boxes) {
  RandomStream stream(1, "corridor");
  std::ostringstream geoms;
  geoms
      << R"(<geom type="plane" size="0 0 1"/><geom type="box" size="200 0.1 1.5" pos="0 2.1 1.5"/>)"
      << R"(<geom type="box" size="200 0.1 1.5" pos="0 -2.1 1.5"/><geom type="box" size="200 2.2 0.1" pos="0 0 3.1"/>)";
  for (int i = 0; i < boxes; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    geoms << "<geom type=\"box\" size=\"" << stream.uniform(0.02, 0.2) << ' ' << stream.uniform(0.02, 0.4) << ' '
          << stream.uniform(0.02, 0.5) << "\" pos=\"" << stream.uniform(-100.0, 100.0) << ' ' << side * 1.9 << ' '
          << stream.uniform(0.0, 3.0) << "\"/>";
  }
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody>" + geoms.str() + "</worldbody></mujoco>";
  return World::from_scene(scene, 1);
}

void BM_Cast(benchmark::State& state) {
  const RayScene scene(corridor(static_cast<int>(state.range(0)) / 12));
  RandomStream stream(2, "rays");
  for (auto _ : state) {
    const double azimuth = stream.uniform(0.0, 2.0 * std::numbers::pi);
    const double sine = stream.uniform(-0.26, 0.26);
    const double cosine = std::sqrt(1.0 - sine * sine);
    benchmark::DoNotOptimize(
        scene.cast({0, 0, 1.5}, {cosine * std::cos(azimuth), cosine * std::sin(azimuth), sine}, 0.0, 100.0));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_Cast)->ArgName("triangles")->Arg(1200)->Arg(24000)->Arg(120000);

void BM_Vlp16Scan(benchmark::State& state) {
  const World world = corridor(static_cast<int>(state.range(0)) / 12);
  const RayScene scene(world);
  const Lidar lidar(vlp16(), Pose{}, 1);
  PoseTrack track;
  for (int i = 0; i <= 20; ++i) {
    track.push(i * 5'000'000, Pose{Eigen::Quaterniond(1.0, 0.0, 0.0, 1e-3 * i).normalized(), {0.01 * i, 0.0, 1.5}});
  }
  std::int64_t index = 0;
  for (auto _ : state) benchmark::DoNotOptimize(lidar.scan({world, scene}, track, 0, index++));
  state.counters["seconds per simulated second"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * 0.1, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_Vlp16Scan)->ArgName("triangles")->Arg(1200)->Arg(24000)->Arg(120000)->Unit(benchmark::kMillisecond);

void BM_BuildScene(benchmark::State& state) {
  const World world = corridor(static_cast<int>(state.range(0)) / 12);
  for (auto _ : state) benchmark::DoNotOptimize(RayScene(world));
}
BENCHMARK(BM_BuildScene)->ArgName("triangles")->Arg(24000)->Arg(120000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumbline
