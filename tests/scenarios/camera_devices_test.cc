// What must hold for every camera of the catalogue, and with every lidar.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenarios/catalogue.h"
#include "sensors/camera.h"
#include "sensors/lidar.h"
#include "sim/ray_scene.h"
#include "sim/renderer.h"
#include "sim/scene_library.h"
#include "tools/verify/photon_transfer.h"

namespace plumbline {
namespace {

TEST(CatalogueCameras, PhotonTransferGivesBackGainReadNoiseAndFullWell) {
  for (const std::string& name : catalogue_names("camera")) {
    const SensorChip chip = catalogue_camera(name).chip;
    const PhotonTransfer found = measure_photon_transfer(chip);
    EXPECT_NEAR(found.electrons_per_count / electrons_per_count(chip, found.gain), 1.0, 0.05) << name;
    EXPECT_NEAR(found.read_noise_electrons / chip.read_noise_electrons, 1.0, 0.10) << name;
    EXPECT_NEAR(found.full_well_electrons / chip.full_well_electrons, 1.0, 0.05) << name;
    RecordProperty(name, std::to_string(found.electrons_per_count / electrons_per_count(chip, found.gain)) + " " +
                             std::to_string(found.read_noise_electrons / chip.read_noise_electrons) + " " +
                             std::to_string(found.full_well_electrons / chip.full_well_electrons));
  }
}

/// The garage without texture, which has nothing to do with depth and takes long to draw.
World plain_garage() {
  SceneDescription scene = build_scene("garage", {}, 1);
  for (Material& material : scene.materials) material.contrast = 0.0F;
  return World::from_scene(scene, 1);
}

struct Agreement {
  int points = 0;
  int within = 0;
};

/// Points of a scan taken from where the camera is, against the least and greatest depth around where they fall.
Agreement compare(const LidarScan& scan, const Pose& camera_from_lidar, const RenderView& view,
                  const std::vector<float>& depth_m) {
  Agreement agreement;
  for (const LidarPoint& point : scan.points) {
    const Eigen::Vector3d in_camera = camera_from_lidar * point.position.cast<double>();
    if (in_camera.z() < view.near_m) continue;
    const auto u = static_cast<int>(std::lround(view.fx * in_camera.x() / in_camera.z() + view.cx));
    const auto v = static_cast<int>(std::lround(view.fy * in_camera.y() / in_camera.z() + view.cy));
    if (u < 1 || v < 1 || u >= view.width - 1 || v >= view.height - 1) continue;
    double least = 1e9;
    double greatest = 0.0;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const double depth = depth_m[static_cast<std::size_t>((v + dv) * view.width + u + du)];
        least = std::min(least, depth);
        greatest = std::max(greatest, depth);
      }
    }
    ++agreement.points;
    if (in_camera.z() > 0.99 * least && in_camera.z() < 1.01 * greatest) ++agreement.within;
  }
  return agreement;
}

/// The rig at rest, so that a whole sweep shows one instant.
PoseTrack resting(const Pose& world_from_body) {
  PoseTrack track;
  track.push(0, world_from_body);
  track.push(2'000'000'000, world_from_body);
  return track;
}

TEST(CatalogueCameras, LidarPointsFallOnTheDepthsThatTheCameraSees) {
  const World world = plain_garage();
  const RayScene rays(world);
  // The middle of the lidar's beams is where the camera stands: from elsewhere they see what is hidden from it. The
  // two blocks of the HDL-64E still begin 5 cm above and below it.
  const Pose body_from_camera{body_from_optical_rotation(), Eigen::Vector3d::Zero()};
  const std::vector<Pose> places{{rotation_from_rpy({0.0, 0.0, 0.3}), {6.0, 4.75, 1.5}},
                                 {rotation_from_rpy({0.05, 0.1, -2.0}), {45.0, -4.75, 1.4}},
                                 {rotation_from_rpy({-0.1, -0.05, 2.6}), {98.0, -4.75, 1.6}}};
  for (const std::string& camera_name : catalogue_names("camera")) {
    CameraEffects effects;
    effects.distortion = false;
    const RenderView view = Lens(catalogue_camera(camera_name), effects).view();
    Renderer renderer(world, view, {.threads = 0, .depth = true});
    for (const std::string& lidar_name : catalogue_names("lidar")) {
      const LidarModel model = catalogue_lidar(lidar_name);
      double middle_m = 0.0;
      for (const LidarBeam& beam : model.beams) {
        middle_m += beam.vertical_offset_m / static_cast<double>(model.beams.size());
      }
      const Pose body_from_lidar{Eigen::Quaterniond::Identity(), {0.0, 0.0, -middle_m}};
      const Lidar lidar(model, body_from_lidar, 1, LidarEffects::none());
      Agreement all;
      for (const Pose& world_from_body : places) {
        RenderMoment moment;
        moment.world_from_body = world_from_body;
        moment.world_from_camera = world_from_body * body_from_camera;
        const std::vector<float> depth_m = renderer.render(moment).depth_m;
        const LidarScan scan = lidar.scan({world, rays}, resting(world_from_body), 0, 0);
        const Agreement one = compare(scan, body_from_camera.inverse() * body_from_lidar, view, depth_m);
        all.points += one.points;
        all.within += one.within;
      }
      EXPECT_GT(all.points, 1000) << camera_name << ' ' << lidar_name;
      EXPECT_GE(all.within, 0.99 * all.points) << camera_name << ' ' << lidar_name;
      RecordProperty(camera_name + "_" + lidar_name, std::to_string(static_cast<double>(all.within) / all.points));
    }
  }
}

}  // namespace
}  // namespace plumbline
