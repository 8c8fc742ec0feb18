#include "scenarios/image_truth.h"

#include "estimator/geometry/lens_distortion.h"
#include "scenarios/session.h"

namespace plumbline {
namespace {

constexpr double kReach_m = 200.0;
// Of a corner tracked over a key-frame, interpolation and changing view included.
constexpr double kPixelSigma_px = 0.25;

Eigen::Vector3d ray_through(const CameraIntrinsics& camera, const Eigen::Vector2f& pixel) {
  const Eigen::Vector2d imaged((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
  return undistort(camera.distortion, imaged).homogeneous().normalized();
}

}  // namespace

std::vector<ImageTrial> label_images(const Scenario& scenario, const World& world, const RayScene& rays,
                                     const std::vector<TrackedImage>& images) {
  const Trajectory world_from_pack = make_body_trajectory(scenario, world, rays);
  const CameraIntrinsics camera = intrinsics_of(scenario.rig.camera.model, scenario.rig.camera.effects);
  std::vector<ImageTrial> trials;
  for (const TrackedImage& image : images) {
    const Pose world_from_camera = world_from_pack.pose(image.stamp_ns) * scenario.rig.camera.pack_from_camera;
    const double time_s = 1e-9 * static_cast<double>(image.stamp_ns);
    const RayWindow window = rays.window(world_from_camera.translation, kReach_m, time_s);
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector2f& pixel : image.pixels) {
      const Eigen::Vector3d ray = ray_through(camera, pixel);
      const RayHit hit =
          window.cast(world_from_camera.translation, world_from_camera.rotation * ray, 0.0, kReach_m, time_s);
      if (hit.hit && world.mover_of(hit.geom) < 0) points.push_back(hit.range_m * ray);
    }
    trials.push_back({image.stamp_ns, static_cast<int>(points.size()),
                      label(image_information(points, camera, kPixelSigma_px), kImageLimits)});
  }
  return trials;
}

}  // namespace plumbline
