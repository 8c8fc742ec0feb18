#pragma once

#include <cstdint>
#include <string>

#include "sensors/lidar.h"

namespace plumbline {

/// A world of a few geoms of one material ("wall"). @param geoms  MJCF
SceneDescription lidar_targets(const std::string& geoms, float reflectivity);

/// A lidar's place at the origin of such a world, where it rests for 100 s.
class LidarStand {
 public:
  explicit LidarStand(const std::string& geoms, float reflectivity = 0.5F);

  LidarScan scan(const Lidar& lidar, std::int64_t message = 0, const OwnBody* own_body = nullptr) const {
    return lidar.scan({world, rays, own_body}, at_rest_, message * lidar.period_ns(), message);
  }

  World world;
  RayScene rays;

 private:
  PoseTrack at_rest_;
};

/// All beams of a lidar that stands in it return, from 9 m.
inline constexpr char kSphere[] = R"(<geom type="sphere" size="9"/>)";

/// The standard normal distribution's.
double normal_cdf(double x);

}  // namespace plumbline
