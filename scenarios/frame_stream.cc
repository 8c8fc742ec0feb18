#include "scenarios/frame_stream.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scenarios/calibration.h"

namespace plumbline {
namespace {

// A frame reaches back from its stamp by half its exposure, at most half a period of the slowest camera.
constexpr std::int64_t kKept_ns = 5'000'000'000;

std::int64_t period_ns(double rate_hz) { return std::llround(1e9 / rate_hz); }

std::int64_t longest_reach_ns(const MountedCamera& mounted) {
  const Shutter shutter = shutter_of(mounted.model, mounted.effects, mounted.model.exposure.max_exposure_s);
  return std::llround(0.5e9 * shutter.span_s());
}

}  // namespace

FrameStream::FrameStream(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body,
                         int renderer_threads)
    : scenario_(scenario),
      surroundings_(surroundings),
      world_from_body_(world_from_body),
      reach_ns_(longest_reach_ns(scenario.rig.camera)),
      renderer_threads_(renderer_threads),
      driver_(world_from_body) {
  add_grey_cameras();
  if (scenario.rig.depth_camera) add_depth_camera(*scenario.rig.depth_camera);
}

Renderer& FrameStream::add_renderer(const RenderView& view, bool depth) {
  const RendererOptions options{.threads = renderer_threads_, .depth = depth, .own_body = surroundings_.own_body};
  return *renderers_.emplace_back(std::make_unique<Renderer>(surroundings_.world, view, options));
}

void FrameStream::add_grey_cameras() {
  const MountedCamera& mounted = scenario_.rig.camera;
  Camera left(mounted.model, mounted.effects, scenario_.seed);
  Renderer& renderer = add_renderer(left.view(), false);
  add_grey_camera(mounted.pack_from_camera, std::move(left), kMainCamera, renderer);
  if (!scenario_.rig.stereo_baseline_m) return;
  add_grey_camera(pack_from_right_camera(scenario_.rig),
                  Camera(mounted.model, mounted.effects, scenario_.seed, "right camera noise"), kRightCamera, renderer);
}

void FrameStream::add_grey_camera(const Pose& pack_from_camera, Camera camera, int camera_id, Renderer& renderer) {
  const std::int64_t period = period_ns(camera.model().rate_hz);
  const auto on_rig = std::make_shared<CameraOnRig>(FilmSet{scenario_, surroundings_, driver_}, pack_from_camera,
                                                    std::move(camera), renderer);
  sources_.push_back({period, [on_rig, camera_id](std::int64_t stamp_ns, std::int64_t frame) {
                        return Payload(camera_frame(on_rig->take(stamp_ns, frame), stamp_ns, camera_id));
                      }});
}

void FrameStream::add_depth_camera(const MountedDepthCamera& mounted) {
  DepthCamera camera(mounted.model, mounted.effects, scenario_.seed, "depth camera noise");
  Renderer& renderer = add_renderer(camera.view(), true);
  sources_.push_back({period_ns(mounted.model.rate_hz), [this, &mounted, &renderer, camera = std::move(camera)](
                                                            std::int64_t stamp_ns, std::int64_t frame) {
                        const RadianceImage& picture =
                            draw({scenario_, surroundings_, driver_}, renderer, mounted.pack_from_camera, stamp_ns);
                        return Payload(camera.measure(picture, stamp_ns, kDepthCamera, frame));
                      }});
}

FrameStream::Source& FrameStream::next_source() {
  return *std::min_element(sources_.begin(), sources_.end(),
                           [](const Source& a, const Source& b) { return a.next_ns() < b.next_ns(); });
}

std::int64_t FrameStream::next_over_ns() const {
  std::int64_t stamp_ns = std::numeric_limits<std::int64_t>::max();
  for (const Source& source : sources_) stamp_ns = std::min(stamp_ns, source.next_ns());
  return stamp_ns + reach_ns_;
}

std::unique_ptr<SensorMessage> FrameStream::next() {
  Source& source = next_source();
  const std::int64_t stamp_ns = source.next_ns();
  if (stamp_ns > world_from_body_.end_ns()) return nullptr;
  auto message = timed_message([&] { return source.take(stamp_ns, source.frame); }, stamp_ns);
  source.frame += scenario_.rig.decimation;
  driver_.forget_before(stamp_ns - kKept_ns);
  return message;
}

}  // namespace plumbline
