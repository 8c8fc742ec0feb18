#include "tests/support/synthetic_record.h"

#include <algorithm>
#include <cmath>

#include "estimator/geometry/so3.h"
#include "sim/random_stream.h"

namespace plumbline::testing {
namespace {

constexpr double kDuration = 40.0;
constexpr double kRest = 2.0;
constexpr double kSpeed = 1.4;
constexpr double kStraight = 25.0;  // [m], then a bend to the left
constexpr double kRadius = 12.0;

std::int64_t to_ns(double time_s) { return static_cast<std::int64_t>(std::llround(time_s * 1e9)); }

/// A body that rests, walks straight on and bends to the left.
Pose true_pose(double time_s) {
  const double along = kSpeed * std::max(0.0, time_s - kRest);
  const double bend = std::max(0.0, along - kStraight) / kRadius;
  const double straight = std::min(along, kStraight);
  const double bob = along > 0.0 ? 0.02 * std::sin(12.0 * time_s) : 0.0;
  Pose pose;
  pose.rotation = rotation_from_rpy({0.01 * std::sin(6.0 * time_s), 0.0, bend});
  pose.translation = {5.0 + straight + kRadius * std::sin(bend), -3.0 + kRadius * (1.0 - std::cos(bend)), 1.5 + bob};
  return pose;
}

/// Starts at the origin, loses 3 % of the way and turns a little too far.
Pose estimated_pose(double time_s) {
  const Pose start_from_body = true_pose(0.0).inverse() * true_pose(time_s);
  const double wander = 0.0008 * std::max(0.0, time_s - kRest);
  const Eigen::Quaterniond turn = exp_so3({0.0, 0.0, wander});
  return {turn * start_from_body.rotation, turn * (0.97 * start_from_body.translation)};
}

ModuleHealth health_at(double time_s, Module module, RandomStream& noise) {
  ModuleHealth health;
  health.stamp_ns = to_ns(time_s);
  health.module = module;
  for (int i = 0; i < 6; ++i) health.eigenvalues[i] = std::pow(10.0, 2.0 + 0.5 * i + 0.1 * noise.gaussian());
  health.well_conditioned = 6;
  health.mode = ModuleMode::kSolved;
  const bool in_straight = time_s > 6.0 && time_s < 18.0;
  const bool in_the_dark = time_s > 24.0 && time_s < 28.0;
  if (module == Module::kLidar && in_straight) {
    health.eigenvalues[0] *= 0.02;
    health.well_conditioned = 5;
    health.mode = ModuleMode::kPartial;
  }
  if (module == Module::kVision && in_the_dark) {
    health.eigenvalues.setZero();
    health.well_conditioned = 0;
    health.mode = ModuleMode::kBypassed;
  }
  for (int i = 0; i < 6; ++i) health.correction[i] = (i < 3 ? 0.001 : 0.01) * noise.gaussian();
  health.rows = 200;
  health.inliers = 180;
  return health;
}

void add_messages(RunRecord& record, Module module, double period_s, double wall_s) {
  RandomStream noise(7, to_string(module).data());
  auto& tally = record.messages[module];
  for (double time_s = period_s; time_s < kDuration; time_s += period_s) {
    ++tally.produced;
    ++tally.used;
    record.timing.push_back({to_ns(time_s), module, wall_s * (1.0 + 0.3 * std::abs(noise.gaussian()))});
    if (module != Module::kImu) record.health.push_back(health_at(time_s, module, noise));
  }
}

/// Walls along the path, a floor and a ceiling, in the estimate's world.
std::vector<MapPoint> corridor_points(RandomStream& noise) {
  std::vector<MapPoint> points;
  for (double time_s = 0.0; time_s < kDuration; time_s += 0.002) {
    const Pose world_from_body = estimated_pose(time_s);
    for (const Eigen::Vector3d& in_body :
         {Eigen::Vector3d(0.0, 2.0, 1.0), Eigen::Vector3d(0.0, -2.0, 1.0), Eigen::Vector3d(0.0, 0.5, -1.5)}) {
      const Eigen::Vector3d spread(0.02 * noise.gaussian(), 0.02 * noise.gaussian(), 0.6 * noise.gaussian());
      points.push_back({(world_from_body * (in_body + spread)).cast<float>(), 0.4F});
    }
  }
  return points;
}

FrameSnapshot snapshot_at(double time_s, RandomStream& noise) {
  FrameSnapshot snapshot;
  snapshot.frame = {to_ns(time_s), 0, 640, 360, {}};
  for (int v = 0; v < 360; ++v) {
    for (int u = 0; u < 640; ++u) {
      const double grey = 110.0 + 40.0 * std::sin(0.05 * u) * std::cos(0.07 * v) + 4.0 * noise.gaussian();
      snapshot.frame.pixels.push_back(static_cast<std::uint8_t>(grey));
    }
  }
  for (int i = 0; i < 200; ++i) {
    TrackedFeature feature;
    feature.pixel = Eigen::Vector2d(320.0 + 110.0 * noise.gaussian(), 180.0 + 60.0 * noise.gaussian()).cast<float>();
    feature.keyframe_pixel = 0.97F * feature.pixel + Eigen::Vector2f(9.6F, 5.4F);
    feature.depth = static_cast<TrackedFeature::Depth>(i % 3);
    feature.inlier = i % 11 != 0;
    snapshot.features.push_back(feature);
  }
  return snapshot;
}

}  // namespace

std::vector<PoseTrack::Stamped> poses_at_200_hz(double duration_s, const std::function<Pose(double)>& pose_at) {
  std::vector<PoseTrack::Stamped> poses;
  const auto count = static_cast<std::int64_t>(std::llround(duration_s * 200.0));
  for (std::int64_t i = 0; i <= count; ++i) {
    poses.push_back({i * 5'000'000, pose_at(static_cast<double>(i) * 0.005)});
  }
  return poses;
}

RunRecord synthetic_record() {
  RunRecord record;
  record.ground_truth = poses_at_200_hz(kDuration, true_pose);
  record.estimate = poses_at_200_hz(kDuration, estimated_pose);
  for (const auto& [stamp_ns, pose] : record.estimate) {
    Odometry odometry;
    odometry.stamp_ns = stamp_ns;
    odometry.world_from_body = pose;
    odometry.increment_covariance = 1e-6 * Matrix6d::Identity();
    record.odometry.push_back(odometry);
  }
  add_messages(record, Module::kImu, 0.005, 8e-6);
  add_messages(record, Module::kVision, 0.02, 6e-3);
  add_messages(record, Module::kLidar, 0.1, 22e-3);
  std::stable_sort(record.health.begin(), record.health.end(),
                   [](const ModuleHealth& a, const ModuleHealth& b) { return a.stamp_ns < b.stamp_ns; });
  record.messages[Module::kVision].dropped["not finite"] = 3;
  RandomStream noise(7, "pictures");
  for (const double time_s : {kDuration / 6.0, kDuration / 2.0, kDuration * 5.0 / 6.0}) {
    record.snapshots.push_back(snapshot_at(time_s, noise));
  }
  record.map = corridor_points(noise);
  record.estimator_wall_s = 24.0;
  record.sensors_wall_s = 12.0;
  return record;
}

}  // namespace plumbline::testing
