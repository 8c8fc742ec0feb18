// What a camera frame costs besides drawing: chip, lens, counting of sub-frames; and how many of these a scenario asks
// for.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <optional>

#include "scenarios/catalogue.h"
#include "scenarios/session.h"
#include "sensors/camera.h"
#include "sensors/depth_camera.h"
#include "sensors/image_motion.h"

namespace plumbline {
namespace {

RadianceImage even_picture(const RenderView& view, float luminance) {
  RadianceImage picture;
  picture.width = view.width;
  picture.height = view.height;
  const auto pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  picture.luminance.assign(pixels, luminance);
  picture.depth_m.assign(pixels, 2.0F);
  return picture;
}

/// Luminance in cd/m^2: 0, some electrons a pixel, thousands.
void BM_ReadOut(benchmark::State& state) {
  Camera camera(catalogue_camera("wide640"), {}, 1);
  const RadianceImage picture = even_picture(camera.view(), 1e-3F * static_cast<float>(state.range(0)));
  std::int64_t frame = 0;
  for (auto _ : state) benchmark::DoNotOptimize(camera_frame(camera.expose(picture, frame++), 0, 0));
}
BENCHMARK(BM_ReadOut)->ArgName("mcd_per_m2")->Arg(0)->Arg(200)->Arg(30000)->Unit(benchmark::kMillisecond);

void BM_AddSubFrame(benchmark::State& state, const char* device) {
  Camera camera(catalogue_camera(device), {}, 1);
  const RadianceImage picture = even_picture(camera.view(), 30.0F);
  camera.begin(4);
  for (auto _ : state) camera.add(picture);
}
BENCHMARK_CAPTURE(BM_AddSubFrame, pinhole, "wide640")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_AddSubFrame, distorted, "euroc_mt9v034")->Unit(benchmark::kMillisecond);

void BM_DepthFrame(benchmark::State& state) {
  const DepthCamera camera(catalogue_depth_camera("xtion"), {}, 1, "depth");
  const RadianceImage picture = even_picture(camera.view(), 30.0F);
  for (auto _ : state) benchmark::DoNotOptimize(camera.measure(picture, 0, 2, 0));
}
BENCHMARK(BM_DepthFrame)->Unit(benchmark::kMillisecond);

/// An iteration counts the sub-frames of one frame, at the longest exposure, along the quickstart's walk.
void BM_QuickstartSubFrames(benchmark::State& state) {
  const Scenario scenario =
      load_scenario(std::filesystem::path(PLUMBLINE_SCENARIO_DIR) / "quickstart.yaml", {}, std::nullopt);
  const World world = make_world(scenario);
  const RayScene rays(world);
  const Trajectory motion = make_body_trajectory(scenario, world, rays);
  const MountedCamera& mounted = scenario.rig.camera;
  const RenderView view = Lens(mounted.model, mounted.effects).view();
  const std::int64_t half_ns = static_cast<std::int64_t>(0.5e9 * mounted.model.exposure.max_exposure_s);
  const std::int64_t period_ns = static_cast<std::int64_t>(1e9 / mounted.model.rate_hz);
  std::int64_t stamp_ns = 0;
  double sum = 0.0;
  double most = 0.0;
  for (auto _ : state) {
    stamp_ns = (stamp_ns + period_ns) % motion.end_ns();
    const CameraSweep sweep{motion.pose(stamp_ns - half_ns) * mounted.pack_from_camera,
                            motion.pose(stamp_ns + half_ns) * mounted.pack_from_camera,
                            1e-9 * static_cast<double>(stamp_ns - half_ns),
                            1e-9 * static_cast<double>(stamp_ns + half_ns)};
    const int count = sub_frame_count(image_motion_px({world, rays}, view, sweep));
    sum += count;
    most = std::max(most, static_cast<double>(count));
  }
  state.counters["mean"] = sum / static_cast<double>(state.iterations());
  state.counters["most"] = most;
}
BENCHMARK(BM_QuickstartSubFrames)->Iterations(4380)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumbline
