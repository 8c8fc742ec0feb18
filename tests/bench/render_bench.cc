// What a picture costs: one 640 x 360 frame on one core, along the way through a scene.
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <string>

#include "sim/renderer.h"
#include "sim/scene_library.h"

namespace plumbline {
namespace {

RenderView wide_view() {
  RenderView view;
  view.fx = view.fy = 320.0 / std::tan(34.0 * std::numbers::pi / 180.0);
  view.cx = 319.5;
  view.cy = 179.5;
  return view;
}

RenderMoment looking_along(const Eigen::Vector3d& position, double yaw) {
  RenderMoment moment;
  moment.world_from_camera = Pose{rotation_from_rpy({0.0, 0.0, yaw}) * body_from_optical_rotation(), position};
  return moment;
}

void BM_Frame(benchmark::State& state, const std::string& scene) {
  const World world = World::from_scene(build_scene(scene, {}, 1), 1);
  Renderer renderer(world, wide_view(), {.threads = 0, .depth = false});
  int k = 0;
  for (auto _ : state) {
    k = (k + 1) % 16;
    benchmark::DoNotOptimize(renderer.render(looking_along({20.0 + k, 4.75, 1.5}, 0.4 * k)).luminance.data());
  }
}
BENCHMARK_CAPTURE(BM_Frame, garage, "garage")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumbline
