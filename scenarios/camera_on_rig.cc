#include "scenarios/camera_on_rig.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "scenarios/sensor_message.h"
#include "sensors/image_motion.h"

namespace plumbline {
namespace {

std::int64_t to_ns(double seconds) { return std::llround(seconds * 1e9); }

}  // namespace

const RadianceImage& draw(const FilmSet& set, Renderer& renderer, const Pose& pack_from_camera, std::int64_t stamp_ns) {
  set.driver.advance_to(stamp_ns);
  RenderMoment moment;
  moment.world_from_body = set.driver.world_from_body().at(stamp_ns);
  moment.world_from_camera = moment.world_from_body * pack_from_camera;
  moment.light_factor = light_factor_at(set.scenario.world.light_schedule, stamp_ns);
  moment.time_s = 1e-9 * static_cast<double>(stamp_ns);
  return renderer.render(moment);
}

CameraOnRig::CameraOnRig(const FilmSet& set, const Pose& pack_from_camera, Camera camera, Renderer& renderer)
    : set_(set), pack_from_camera_(pack_from_camera), camera_(std::move(camera)), renderer_(renderer) {}

RawImage CameraOnRig::take(std::int64_t stamp_ns, std::int64_t frame_index) {
  const Shutter shutter = camera_.shutter();
  const int pictures = pictures_for(stamp_ns, shutter);
  const bool one = was_unseen_ && pictures > 1 && !light_changes(stamp_ns, shutter);
  was_unseen_ = add_pictures(stamp_ns, shutter, one ? 1 : pictures);
  if (one && !was_unseen_) add_pictures(stamp_ns, shutter, pictures);
  return camera_.read_out(frame_index);
}

bool CameraOnRig::add_pictures(std::int64_t stamp_ns, const Shutter& shutter, int count) {
  camera_.begin(count);
  bool unseen = true;
  for (int i = 0; i < count; ++i) {
    const std::int64_t time_ns = stamp_ns + to_ns(sub_frame_offset_s(shutter, i, count));
    const RadianceImage& picture = draw(set_, renderer_, pack_from_camera_, time_ns);
    unseen = unseen && camera_.is_unseen(picture);
    camera_.add(picture);
  }
  return unseen;
}

bool CameraOnRig::light_changes(std::int64_t stamp_ns, const Shutter& shutter) const {
  const std::int64_t half_ns = to_ns(0.5 * shutter.span_s());
  const auto& steps = set_.scenario.world.light_schedule;
  return std::any_of(steps.begin(), steps.end(),
                     [&](const LightStep& step) { return std::abs(to_ns(step.start_s) - stamp_ns) <= half_ns; });
}

int CameraOnRig::pictures_for(std::int64_t stamp_ns, const Shutter& shutter) const {
  const std::int64_t half_ns = to_ns(0.5 * shutter.span_s());
  if (half_ns == 0) return 1;
  set_.driver.advance_to(stamp_ns + half_ns);
  const PoseTrack& world_from_body = set_.driver.world_from_body();
  CameraSweep sweep;
  sweep.world_from_camera_at_begin = world_from_body.at(stamp_ns - half_ns) * pack_from_camera_;
  sweep.world_from_camera_at_end = world_from_body.at(stamp_ns + half_ns) * pack_from_camera_;
  sweep.begin_s = 1e-9 * static_cast<double>(stamp_ns - half_ns);
  sweep.end_s = 1e-9 * static_cast<double>(stamp_ns + half_ns);
  return sub_frame_count(image_motion_px(set_.surroundings, camera_.view(), sweep));
}

}  // namespace plumbline
