#include "tools/mount/mount_predictor.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/geometry/so3.h"
#include "scenarios/config_reader.h"
#include "scenarios/session.h"
#include "sensors/information.h"
#include "tools/evaluation/quantile.h"

namespace plumbline {
namespace {

constexpr int kPlaces = 40;
constexpr std::size_t kEveryCycle = 4;  // a quarter of the rays tells the same
constexpr std::int64_t kKnot_ns = 20'000'000;

// Surfaces are counted in cells of a metre, as far as a lidar maps them well.
constexpr double kCell_m = 1.0;
constexpr double kSurfaceReach_m = 30.0;
constexpr int kSurfaceRays = 3000;

// The image's rays stand for its features: about as many as vision tracks.
constexpr int kImageColumns = 24;
constexpr int kImageRows = 14;
constexpr double kImageReach_m = 60.0;
constexpr double kPixelSigma_px = 0.5;
constexpr float kLeastContrast = 0.05F;

// What one registration may use: the estimator takes so many points of a scan, and a key-frame is left after a second
// or when three tenths of what it saw are gone.
constexpr double kPointBudget = 1200.0;
constexpr double kKeyframeShift = 0.3;
constexpr double kKeyframeAge_s = 1.0;
// Dead reckoning alone, per metre: finite, and bad.
constexpr double kReckoning_m = 0.1;
constexpr double kReckoning_rad = 0.01;

/// Directions spread evenly over the sphere: Fibonacci's lattice.
Eigen::Vector3d lattice_direction(int i, int count) {
  const double z = 1.0 - (2.0 * i + 1.0) / count;
  const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

Matrix6d in_body(const Matrix6d& information, const Pose& body_from_sensor) {
  const Matrix6d ad = adjoint(body_from_sensor.inverse());
  return ad.transpose() * information * ad;
}

}  // namespace

/// From one place.
struct MountPredictor::Sight {
  Pose world_from_body;
  Matrix6d scan = Matrix6d::Zero();   ///< information about the lidar's pose, of a whole scan
  Matrix6d drift = Matrix6d::Zero();  ///< covariance of the body's drift per metre
  double mean_range_m = 0.0;
  std::size_t points = 0;
  std::size_t fired = 0;
  std::size_t on_own_body = 0;
  std::vector<Eigen::Vector3d> points_in_world;  ///< of the lidar
  Matrix6d image = Matrix6d::Zero();             ///< information about the camera's pose
  double median_depth_m = 0.0;
  int image_hits = 0;
  int image_own = 0;
  int image_overlap = 0;
};

MountPredictor::MountPredictor(const Scenario& scenario, const std::vector<std::string>& surfaces)
    : world_(make_world(scenario)), rays_(world_), own_body_(make_own_body(scenario)) {
  try {
    choose_places(make_trajectory(scenario.motion, world_, rays_, scenario.seed), scenario.rig);
  } catch (const std::invalid_argument& error) {
    throw InputError(scenario.path.string() + ": " + error.what());
  }
  for (const std::string& name : surfaces) {
    const auto& materials = world_.materials();
    const bool known =
        std::any_of(materials.begin(), materials.end(), [&](const Material& m) { return m.name == name; });
    if (known) continue;
    std::vector<std::string> names;
    for (const Material& material : materials) names.push_back(material.name);
    throw InputError("surfaces: found '" + name + "', which " + scenario.path.string() + " does not have; it has " +
                     joined(names));
  }
  find_surfaces(scenario.rig, surfaces);
}

void MountPredictor::choose_places(const Trajectory& world_from_vehicle, const RigConfig& rig) {
  const std::int64_t sweep_ns = message_period_ns(rig.lidar) * messages_per_sweep(rig.lidar);
  const std::int64_t sweeps = world_from_vehicle.end_ns() / sweep_ns;
  std::vector<double> path_m{0.0};
  for (std::int64_t k = 1; k < sweeps; ++k) {
    path_m.push_back(path_m.back() + (world_from_vehicle.pose(k * sweep_ns).translation -
                                      world_from_vehicle.pose((k - 1) * sweep_ns).translation)
                                         .norm());
  }
  std::int64_t sweep = 0;
  for (int i = 0; i < kPlaces && sweeps > 0; ++i) {
    const double wanted_m = path_m.back() * (i + 0.5) / kPlaces;
    while (sweep + 1 < sweeps && path_m[static_cast<std::size_t>(sweep)] < wanted_m) ++sweep;
    Place place{sweep * sweep_ns, sweep, {}, path_m.back() / kPlaces};
    const std::int64_t end_ns = place.stamp_ns + sweep_ns;
    for (std::int64_t t = place.stamp_ns; t < end_ns; t += kKnot_ns) {
      place.world_from_vehicle.push(t, world_from_vehicle.pose(t));
    }
    place.world_from_vehicle.push(end_ns, world_from_vehicle.pose(end_ns));
    places_.push_back(std::move(place));
  }
  if (places_.empty()) throw std::invalid_argument("motion: too short for a single sweep of the lidar");
}

MountPredictor::Cell MountPredictor::cell_of(const Eigen::Vector3d& point) {
  const auto index = [](double x) { return static_cast<int>(std::floor(x / kCell_m)); };
  return {index(point.x()), index(point.y()), index(point.z())};
}

void MountPredictor::find_surfaces(const RigConfig& rig, const std::vector<std::string>& materials) {
  const auto matters = [&](int geom) {
    const std::string& name = world_.materials()[static_cast<std::size_t>(world_.material_of(geom))].name;
    return world_.mover_of(geom) < 0 &&
           (materials.empty() || std::find(materials.begin(), materials.end(), name) != materials.end());
  };
  for (const Place& place : places_) {
    const Pose pack = place.world_from_vehicle.at(place.stamp_ns) * rig.vehicle_from_pack;
    const RayWindow window = rays_.window(pack.translation, kSurfaceReach_m);
    for (int i = 0; i < kSurfaceRays; ++i) {
      const Eigen::Vector3d direction = lattice_direction(i, kSurfaceRays);
      const RayHit hit = window.cast(pack.translation, direction, 0.0, kSurfaceReach_m, 0.0);
      if (hit.hit && matters(hit.geom)) surfaces_.insert(cell_of(pack.translation + hit.range_m * direction));
    }
  }
}

const OwnBody* MountPredictor::own_body(const RigConfig& rig) {
  if (own_body_) own_body_->body_from_vehicle = rig.vehicle_from_pack.inverse();
  return own_body_.get();
}

void MountPredictor::look_with_lidar(const Place& place, const RigConfig& rig, Sight& sight) {
  PoseTrack world_from_body;
  const std::int64_t part_ns = message_period_ns(rig.lidar);
  const int parts = messages_per_sweep(rig.lidar);
  const std::int64_t end_ns = place.stamp_ns + parts * part_ns;
  for (std::int64_t t = place.stamp_ns; t < end_ns; t += kKnot_ns) {
    world_from_body.push(t, place.world_from_vehicle.at(t) * rig.vehicle_from_pack);
  }
  world_from_body.push(end_ns, place.world_from_vehicle.at(end_ns) * rig.vehicle_from_pack);
  sight.world_from_body = world_from_body.at(end_ns);

  const TrueReturns lidar(rig.lidar, rig.pack_from_lidar);
  const Surroundings surroundings{world_, rays_, own_body(rig)};
  const Pose end_from_world = (sight.world_from_body * rig.pack_from_lidar).inverse();
  std::vector<SurfacePoint> points;
  for (int part = 0; part < parts; ++part) {
    const std::int64_t start_ns = place.stamp_ns + part * part_ns;
    const auto scan = lidar.cast(surroundings, world_from_body, start_ns, place.sweep * parts + part, kEveryCycle);
    sight.fired += scan.fired;
    sight.on_own_body += scan.on_own_body;
    const Pose world_from_lidar = world_from_body.at(start_ns + part_ns) * rig.pack_from_lidar;
    const Pose end_from_part = end_from_world * world_from_lidar;
    for (const SurfacePoint& point : scan.points) {
      points.push_back({end_from_part * point.position, end_from_part.rotation * point.normal});
      sight.points_in_world.push_back(world_from_lidar * point.position);
      sight.mean_range_m += point.position.norm();
    }
  }
  sight.points = points.size();
  sight.mean_range_m /= std::max<double>(1.0, static_cast<double>(points.size()));
  sight.scan = static_cast<double>(kEveryCycle) * lidar_information(points, rig.lidar.accuracy_sigma_m);
}

void MountPredictor::look_with_camera(const Place& place, const RigConfig& rig, Sight& sight) {
  const CameraIntrinsics camera = intrinsics_of(rig.camera.model);
  const std::int64_t stamp_ns = place.world_from_vehicle.last_ns();
  const Pose body_from_camera = rig.camera.pack_from_camera;
  const Pose world_from_camera = sight.world_from_body * body_from_camera;
  const Pose camera_from_world = world_from_camera.inverse();
  std::vector<bool> seen_by_lidar(static_cast<std::size_t>(kImageColumns * kImageRows));
  for (const Eigen::Vector3d& point : sight.points_in_world) {
    const Eigen::Vector3d p = camera_from_world * point;
    if (p.z() <= 0.0) continue;
    const double u = camera.fx * p.x() / p.z() + camera.cx;
    const double v = camera.fy * p.y() / p.z() + camera.cy;
    if (u < 0.0 || v < 0.0 || u >= camera.width || v >= camera.height) continue;
    const int column = static_cast<int>(u * kImageColumns / camera.width);
    const int row = static_cast<int>(v * kImageRows / camera.height);
    seen_by_lidar[static_cast<std::size_t>(row * kImageColumns + column)] = true;
  }

  const double time_s = 1e-9 * static_cast<double>(stamp_ns);
  const RayWindow window = rays_.window(world_from_camera.translation, kImageReach_m, time_s);
  const OwnBody* own = own_body(rig);
  std::vector<Eigen::Vector3d> features;
  std::vector<double> depths;
  for (int i = 0; i < kImageColumns * kImageRows; ++i) {
    const double u = (i % kImageColumns + 0.5) * camera.width / kImageColumns;
    const double v = (i / kImageColumns + 0.5) * camera.height / kImageRows;
    const Eigen::Vector3d ray =
        Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0).normalized();
    const RayHit hit =
        window.cast(world_from_camera.translation, world_from_camera.rotation * ray, 0.0, kImageReach_m, time_s);
    if (own != nullptr) {
      const Pose vehicle_from_camera = rig.vehicle_from_pack * body_from_camera;
      const RayHit on_own = own->rays.cast(vehicle_from_camera.translation, vehicle_from_camera.rotation * ray, 0.0,
                                           hit.hit ? hit.range_m : kImageReach_m);
      if (on_own.hit) {
        ++sight.image_own;
        continue;
      }
    }
    if (!hit.hit || world_.mover_of(hit.geom) >= 0) continue;
    ++sight.image_hits;
    sight.image_overlap += seen_by_lidar[static_cast<std::size_t>(i)] ? 1 : 0;
    const Material& material = world_.materials()[static_cast<std::size_t>(world_.material_of(hit.geom))];
    if (material.contrast < kLeastContrast) continue;
    features.push_back(hit.range_m * ray);
    depths.push_back(features.back().z());
  }
  sight.image = image_information(features, camera, kPixelSigma_px);
  sight.median_depth_m = quantile(depths, 0.5).value_or(0.0);
}

MountPredictor::Sight MountPredictor::look(const Place& place, const RigConfig& rig) {
  Sight sight;
  look_with_lidar(place, rig, sight);
  look_with_camera(place, rig, sight);
  // A scan is registered against what was mapped from about its own range away, an image against its key-frame: the
  // longer the way that one sight lasts, the fewer registrations a metre takes.
  const double speed_mps = place.step_m > 0.0
                               ? (place.world_from_vehicle.at(place.world_from_vehicle.last_ns()).translation -
                                  place.world_from_vehicle.at(place.stamp_ns).translation)
                                         .norm() /
                                     seconds_between(place.stamp_ns, place.world_from_vehicle.last_ns())
                               : 0.0;
  const double scan_lasts_m = sight.mean_range_m;
  const double image_lasts_m = std::min(kKeyframeShift * sight.median_depth_m, kKeyframeAge_s * speed_mps);
  const double whole_points = static_cast<double>(kEveryCycle * sight.points);
  const double used = whole_points > 0.0 ? std::min(1.0, kPointBudget / whole_points) : 0.0;
  Matrix6d information = Matrix6d::Zero();
  information.diagonal() << Eigen::Vector3d::Constant(1.0 / (kReckoning_rad * kReckoning_rad)),
      Eigen::Vector3d::Constant(1.0 / (kReckoning_m * kReckoning_m));
  information += scan_lasts_m * used * in_body(sight.scan, rig.pack_from_lidar);
  information += image_lasts_m * in_body(sight.image, rig.camera.pack_from_camera);
  sight.drift = information.ldlt().solve(Matrix6d::Identity());
  return sight;
}

MountPrediction MountPredictor::predict(const RigConfig& rig) {
  std::vector<Sight> sights;
  for (const Place& place : places_) sights.push_back(look(place, rig));

  MountPrediction prediction;
  const Eigen::Vector3d end = sights.back().world_from_body.translation;
  double variance = 0.0;
  double path_m = 0.0;
  std::vector<double> excesses;
  std::set<Cell> seen;
  std::size_t fired = 0;
  std::size_t on_own_body = 0;
  int image_hits = 0;
  int image_own = 0;
  int image_overlap = 0;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const Sight& sight = sights[i];
    // Gravity keeps roll and pitch; a turn of the heading swings all of the way that is left.
    const Eigen::Matrix3d rotation = sight.world_from_body.rotation.toRotationMatrix();
    const Eigen::Matrix3d heading = Eigen::Vector3d::UnitZ() * Eigen::RowVector3d::UnitZ() * rotation;
    Eigen::Matrix<double, 3, 6> d_end_d_drift;
    d_end_d_drift << -skew(end - sight.world_from_body.translation) * heading, rotation;
    variance += places_[i].step_m * (d_end_d_drift * sight.drift * d_end_d_drift.transpose()).trace();
    path_m += places_[i].step_m;
    excesses.push_back(label(sight.scan, kLidarLimits).excess[0]);
    for (const Eigen::Vector3d& point : sight.points_in_world) {
      if (surfaces_.contains(cell_of(point))) seen.insert(cell_of(point));
    }
    fired += sight.fired;
    on_own_body += sight.on_own_body;
    image_hits += sight.image_hits;
    image_own += sight.image_own;
    image_overlap += sight.image_overlap;
  }
  const auto share = [](auto part, auto whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  prediction.drift_percent = path_m > 0.0 ? 100.0 * std::sqrt(variance) / path_m : 0.0;
  prediction.worst_direction = quantile(excesses, 0.9).value_or(0.0);
  prediction.degenerate_time = share(
      std::count_if(excesses.begin(), excesses.end(), [](double excess) { return excess > 1.0; }), excesses.size());
  prediction.coverage = share(seen.size(), surfaces_.size());
  prediction.own_body_share = std::max(share(on_own_body, fired),
                                       share(image_own, kImageColumns * kImageRows * static_cast<int>(sights.size())));
  prediction.overlap = share(image_overlap, image_hits);
  return prediction;
}

MountView MountPredictor::view(const RigConfig& rig) {
  constexpr double kReach_m = 100.0;
  const Place& place = places_[places_.size() / 2];
  const std::int64_t stamp_ns = place.stamp_ns;
  const double time_s = 1e-9 * static_cast<double>(stamp_ns);
  const Pose world_from_vehicle = place.world_from_vehicle.at(stamp_ns);
  const OwnBody* own = own_body(rig);
  const auto cast = [&](const Pose& pack_from_sensor, const Eigen::Vector3d& ray, MountView::Picture& picture) {
    const Pose vehicle_from_sensor = rig.vehicle_from_pack * pack_from_sensor;
    const Pose world_from_sensor = world_from_vehicle * vehicle_from_sensor;
    const Eigen::Vector3d direction = world_from_sensor.rotation * ray;
    const RayHit hit = rays_.cast(world_from_sensor.translation, direction, 0.0, kReach_m, time_s);
    float range_m = hit.hit ? static_cast<float>(hit.range_m) : 0.0F;
    float brightness = 0.0F;
    if (hit.hit) {
      const Material& material = world_.materials()[static_cast<std::size_t>(world_.material_of(hit.geom))];
      brightness =
          std::min(1.0F, material.albedo * (0.4F + 0.6F * std::abs(hit.normal_in_world.dot(direction.cast<float>()))));
    }
    if (own != nullptr) {
      const RayHit on_own = own->rays.cast(vehicle_from_sensor.translation, vehicle_from_sensor.rotation * ray, 0.0,
                                           hit.hit ? hit.range_m : kReach_m);
      if (on_own.hit) {
        range_m = static_cast<float>(on_own.range_m);
        brightness = -1.0F;
      }
    }
    picture.range_m.push_back(range_m);
    picture.brightness.push_back(brightness);
  };

  MountView view;
  std::vector<double> elevations;
  for (const LidarBeam& beam : rig.lidar.beams) elevations.push_back(beam.elevation_deg * std::numbers::pi / 180.0);
  std::sort(elevations.rbegin(), elevations.rend());
  constexpr int kAround = 360;
  view.lidar = {kAround, static_cast<int>(elevations.size()), {}, {}};
  for (const double elevation : elevations) {
    for (int i = 0; i < kAround; ++i) {
      const double azimuth = std::numbers::pi * (1.0 - 2.0 * (i + 0.5) / kAround);
      cast(rig.pack_from_lidar,
           {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)},
           view.lidar);
    }
  }
  const CameraIntrinsics camera = intrinsics_of(rig.camera.model);
  constexpr int kWidth = 240;
  const int height = kWidth * camera.height / camera.width;
  view.camera = {kWidth, height, {}, {}};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double u = (column + 0.5) * camera.width / kWidth;
      const double v = (row + 0.5) * camera.height / height;
      cast(rig.camera.pack_from_camera,
           Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0).normalized(), view.camera);
    }
  }
  return view;
}

}  // namespace plumbline
