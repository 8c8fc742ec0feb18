#include "sensors/true_returns.h"

#include "sensors/lidar_air.h"
#include "sensors/lidar_caster.h"

namespace plumbline {

TrueReturns::TrueReturns(const LidarModel& model, const Pose& body_from_lidar)
    : model_(model), pattern_(model), signal_(model), body_from_lidar_(body_from_lidar) {}

TrueReturns::Scan TrueReturns::cast(const Surroundings& surroundings, const PoseTrack& world_from_body,
                                    std::int64_t start_ns, std::int64_t scan_index, std::size_t every) const {
  LidarCaster caster(surroundings, surroundings.own_body, world_from_body, body_from_lidar_, pattern_, start_ns,
                     model_.max_range_m);
  const LidarAir air(surroundings.world.atmosphere, model_);
  const Pose world_from_start = world_from_body.at(start_ns) * body_from_lidar_;
  const Pose end_from_world = (world_from_body.at(start_ns + message_period_ns(model_)) * body_from_lidar_).inverse();
  const auto is_found = [&](const LidarHit& hit) {
    if (hit.range_m < model_.min_range_m) return false;
    return signal_.strength(hit.range_m, double{hit.reflectivity} * double{hit.cos_incidence},
                            air.transmission(hit.range_m)) >= 1.0;
  };

  Scan scan;
  const std::vector<FiringPattern::Cycle> cycles = pattern_.cycles(scan_index, /*read_exactly=*/true);
  scan.points.reserve(cycles.size() / every * pattern_.beams().size());
  for (std::size_t k = 0; k < cycles.size(); k += every) {
    const HeadMotion motion = caster.motion_of(cycles[k]);
    for (const FiringPattern::Beam& beam : pattern_.beams()) {
      const std::int64_t time_ps = cycles[k].offset_ps + beam.offset_ps;
      if (time_ps < 0 || time_ps >= pattern_.message_ps()) continue;
      ++scan.fired;
      const LidarHit hit = caster.cast(motion, {beam.origin_in_head, beam.direction_in_head}, time_ps);
      if (hit.is_none()) continue;
      scan.on_own_body += hit.is_own ? 1 : 0;
      if (!hit.stands || !is_found(hit)) continue;
      scan.points.push_back({end_from_world * (world_from_start.translation + hit.point.cast<double>()),
                             end_from_world.rotation * hit.normal.cast<double>()});
    }
  }
  return scan;
}

}  // namespace plumbline
