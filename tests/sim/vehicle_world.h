#pragma once

#include <cmath>
#include <string>

#include "sim/motion.h"
#include "sim/vehicles/vehicle.h"

namespace plumbline::testing {

/// Level ground with routes: a straight one of 701 m, an oval, and a figure of eight through the air.
inline World vehicle_world(const std::string& more_geoms = "") {
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody><geom type='plane' size='0 0 1'/>" + more_geoms + "</worldbody></mujoco>";
  Route straight{.name = "straight", .points = {}, .closed = false};
  for (int i = 0; i <= 70; ++i) straight.points.emplace_back(701.0 * i / 70.0, 0.0, 0.0);
  Route oval{.name = "oval", .points = {}, .closed = true};
  Route eight{.name = "eight", .points = {}, .closed = true};
  for (int i = 0; i < 40; ++i) {
    const double a = 2.0 * M_PI * i / 40.0;
    oval.points.emplace_back(40.0 * std::cos(a), 25.0 * std::sin(a), 0.0);
    eight.points.emplace_back(13.0 * std::sin(a), 6.5 * std::sin(2.0 * a), 3.0 + 0.8 * std::cos(a));
  }
  Route corner{.name = "corner", .points = {}, .closed = false};
  for (int i = 0; i <= 10; ++i) corner.points.emplace_back(2.0 * i, 0.0, 0.0);
  for (int i = 1; i <= 10; ++i) corner.points.emplace_back(20.0, 2.0 * i, 0.0);
  scene.routes = {straight, oval, eight, corner};
  return World::from_scene(scene, 1);
}

inline MotionConfig by_vehicle(const std::string& vehicle, const std::string& route) {
  MotionConfig config = vehicle_named(vehicle).defaults;
  config.route = route;
  return config;
}

inline double duration_s(const Trajectory& trajectory) { return 1e-9 * static_cast<double>(trajectory.end_ns()); }

}  // namespace plumbline::testing
