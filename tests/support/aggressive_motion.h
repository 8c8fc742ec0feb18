#pragma once

#include "sim/motion.h"

namespace plumbline::testing {

/// Rounds of a hall at flight speed, tilted into the turns and swinging: over 60 s long, above 5 m/s, 200 deg/s and
/// 1 g beyond gravity.
inline MotionConfig aggressive_motion() {
  MotionConfig config;
  config.attitude = MotionConfig::Attitude::kThrust;
  config.speed_mps = 6.0;
  config.acceleration_mps2 = 6.0;
  config.smoothing_s = 1.0;
  config.oscillations = {{Oscillation::Axis::kYaw, 25.0, 1.3}, {Oscillation::Axis::kRoll, 8.0, 2.1}};
  for (int round = 0; round < 6; ++round) {
    const double z = 3.0 + 0.5 * (round % 3);
    config.waypoints.push_back({{-12.0, -6.0, z}});
    config.waypoints.push_back({{12.0, -7.0, z + 1.0}});
    config.waypoints.push_back({{11.0, 7.0, z + 2.0}});
    config.waypoints.push_back({{-11.0, 6.0, z + 0.5}});
  }
  return config;
}

}  // namespace plumbline::testing
