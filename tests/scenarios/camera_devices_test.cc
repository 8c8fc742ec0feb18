// What must hold for every camera of the catalogue, and with every lidar.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenarios/catalogue.h"
#include "sensors/camera.h"
#include "sensors/lidar.h"
#include "sim/ray_scene.h"
#include "sim/renderer.h"
#include "sim/scene_library.h"

namespace plumbline {
namespace {

/// A flat field's mean and temporal variance, from the difference of a pair of images, as EMVA 1288 measures them.
struct FlatField {
  double mean = 0.0;      // 10-bit counts
  double variance = 0.0;  // of one image, quantisation taken off
};

FlatField flat_field(const SensorChip& chip, double gain, double electrons, std::uint64_t seed) {
  constexpr int kSide = 256;
  const std::vector<float> light(kSide * kSide, static_cast<float>(electrons));
  const ExposureSettings settings{1e-3, gain};
  const RawImage a = read_out(chip, settings, {}, light, kSide, kSide, seed);
  const RawImage b = read_out(chip, settings, {}, light, kSide, kSide, seed ^ 0x9e3779b97f4a7c15ULL);
  FlatField field;
  for (std::size_t i = 0; i < a.counts.size(); ++i) {
    const double difference = static_cast<double>(a.counts[i]) - b.counts[i];
    field.mean += 0.5 * (a.counts[i] + b.counts[i]);
    field.variance += 0.5 * difference * difference;
  }
  const auto n = static_cast<double>(a.counts.size());
  field.mean /= n;
  field.variance = field.variance / n - 1.0 / 12.0;
  return field;
}

struct PhotonTransfer {
  double electrons_per_count = 0.0;
  double read_noise_electrons = 0.0;
  double full_well_electrons = 0.0;
};

/// Least squares of variance over mean up to 70 % of saturation, which is where the variance is greatest.
PhotonTransfer measure(const SensorChip& chip, double gain) {
  constexpr int kLevels = 60;
  const FlatField dark = flat_field(chip, gain, 0.0, 1);
  std::vector<FlatField> fields;
  for (int i = 1; i <= kLevels; ++i) {
    const double electrons = 1.2 * chip.full_well_electrons * i / kLevels;
    fields.push_back(flat_field(chip, gain, electrons, static_cast<std::uint64_t>(100 + i)));
  }
  const auto saturation = std::max_element(
      fields.begin(), fields.end(), [](const FlatField& a, const FlatField& b) { return a.variance < b.variance; });
  double products = 0.0;
  double squares = 0.0;
  for (const FlatField& field : fields) {
    const double signal = field.mean - dark.mean;
    if (signal > 0.7 * (saturation->mean - dark.mean)) continue;
    products += signal * (field.variance - dark.variance);
    squares += signal * signal;
  }
  const double electrons_per_count = squares / products;
  return {electrons_per_count, std::sqrt(dark.variance) * electrons_per_count,
          (saturation->mean - dark.mean) * electrons_per_count};
}

TEST(CatalogueCameras, PhotonTransferGivesBackGainReadNoiseAndFullWell) {
  for (const std::string& name : catalogue_names("camera")) {
    SensorChip chip = catalogue_camera(name).chip;
    chip.dark_current_electrons_per_s = 0.0;  // EMVA extrapolates to no exposure
    // The well's fullness at 70 % of the converter's range.
    const double gain = 0.7 * 1000.0 * 0.25 * chip.electrons_per_dn / chip.full_well_electrons;
    const PhotonTransfer found = measure(chip, gain);
    const double electrons_per_count = 0.25 * chip.electrons_per_dn / gain;
    EXPECT_NEAR(found.electrons_per_count / electrons_per_count, 1.0, 0.05) << name;
    EXPECT_NEAR(found.read_noise_electrons / chip.read_noise_electrons, 1.0, 0.10) << name;
    EXPECT_NEAR(found.full_well_electrons / chip.full_well_electrons, 1.0, 0.05) << name;
    RecordProperty(name, std::to_string(found.electrons_per_count / electrons_per_count) + " " +
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
