#include "sensors/image_motion.h"

#include <algorithm>

namespace plumbline {
namespace {

constexpr int kColumns = 9;
constexpr int kRows = 6;
constexpr double kReach_m = 50.0;

Eigen::Vector2d project(const RenderView& view, const Eigen::Vector3d& point) {
  return {view.fx * point.x() / point.z() + view.cx, view.fy * point.y() / point.z() + view.cy};
}

/// How a point of a geom moves in the world between two times.
Pose world_at_end_from_world_at_begin(const World& world, int geom, const CameraSweep& sweep) {
  const int mover = geom < 0 ? -1 : world.mover_of(geom);
  if (mover < 0) return {};
  const auto moving = static_cast<std::size_t>(mover);
  return world.pose_of_mover(moving, sweep.end_s) * world.pose_of_mover(moving, sweep.begin_s).inverse();
}

}  // namespace

double image_motion_px(const Surroundings& surroundings, const RenderView& view, const CameraSweep& sweep) {
  const Pose& begin = sweep.world_from_camera_at_begin;
  const Pose camera_from_world_at_end = sweep.world_from_camera_at_end.inverse();
  const RayWindow window = surroundings.rays.window(begin.translation, kReach_m, sweep.begin_s);
  double greatest_px = 0.0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Eigen::Vector2d pixel(column * (view.width - 1.0) / (kColumns - 1),
                                  row * (view.height - 1.0) / (kRows - 1));
      const Eigen::Vector3d in_camera((pixel.x() - view.cx) / view.fx, (pixel.y() - view.cy) / view.fy, 1.0);
      const Eigen::Vector3d direction = begin.rotation * in_camera.normalized();
      const RayHit hit = window.cast(begin.translation, direction, view.near_m, kReach_m, sweep.begin_s);
      const Eigen::Vector3d point = begin.translation + (hit.hit ? hit.range_m : kReach_m) * direction;
      const Pose carried = world_at_end_from_world_at_begin(surroundings.world, hit.geom, sweep);
      const Eigen::Vector3d at_end = camera_from_world_at_end * (carried * point);
      // What passes the camera meanwhile is blurred beyond all counting.
      if (at_end.z() < view.near_m) continue;
      greatest_px = std::max(greatest_px, (project(view, at_end) - pixel).norm());
    }
  }
  return greatest_px;
}

}  // namespace plumbline
