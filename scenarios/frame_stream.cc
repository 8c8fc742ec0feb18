#include "scenarios/frame_stream.h"

#include <cmath>

namespace plumbline {
namespace {

RenderView view_of(const CameraModel& model) {
  const CameraIntrinsics intrinsics = intrinsics_of(model);
  RenderView view;
  view.width = intrinsics.width;
  view.height = intrinsics.height;
  view.fx = intrinsics.fx;
  view.fy = intrinsics.fy;
  view.cx = intrinsics.cx;
  view.cy = intrinsics.cy;
  return view;
}

}  // namespace

FrameStream::FrameStream(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body)
    : scenario_(scenario),
      end_ns_(world_from_body.end_ns()),
      driver_(surroundings.world, world_from_body),
      renderer_(surroundings.world, view_of(scenario.rig.camera),
                {.threads = 0, .depth = false, .own_body = surroundings.own_body}),
      camera_(scenario.rig.camera, scenario.seed),
      period_ns_(std::llround(1e9 / scenario.rig.camera.rate_hz)) {
  camera_.noise_enabled = scenario.rig.camera_noise;
}

std::unique_ptr<SensorMessage> FrameStream::next() {
  const std::int64_t stamp_ns = frame_ * period_ns_ + period_ns_ / 2;
  if (stamp_ns > end_ns_) return nullptr;
  auto message = timed_message([&] { return expose(stamp_ns); }, stamp_ns);
  frame_ += scenario_.rig.decimation;
  return message;
}

CameraFrame FrameStream::expose(std::int64_t stamp_ns) {
  driver_.advance_to(stamp_ns);
  RenderMoment moment;
  moment.world_from_body = driver_.world_from_body().at(stamp_ns);
  moment.world_from_camera = moment.world_from_body * scenario_.rig.pack_from_camera;
  moment.light_factor = light_factor_at(scenario_.world.light_schedule, stamp_ns);
  moment.time_s = 1e-9 * static_cast<double>(stamp_ns);
  driver_.forget_before(stamp_ns);
  return camera_.expose(renderer_.render(moment), stamp_ns, frame_);
}

}  // namespace plumbline
