// What matching a scan to the map costs on one core, against PCL's point-to-plane registration of the same planar
// points to the same map's points: process time per 1,000 points of the scan.
#include <benchmark/benchmark.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>

#include <ctime>

#include "estimator/lidar/deskew.h"
#include "estimator/lidar/features.h"
#include "estimator/lidar/scan_matcher.h"
#include "tests/support/box_world.h"

namespace plumbline {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

constexpr double kRangeSigma_m = 0.012;
constexpr double kStep_m = 0.3;  // between scans: 1.5 m/s at 5 Hz
constexpr int kMappedScans = 20;

FeatureCloud scan_at(const testing::BoxWorld& world, const Pose& pose, const Calibration& calibration,
                     RandomStream& noise) {
  const LidarScan scan = testing::vlp16_scan(
      world, [&](double) { return pose; }, 0, calibration.body_from_lidar, kRangeSigma_m, noise);
  PoseTrack rest;
  rest.push(0, {});
  return extract_features(scan, deskew(scan, rest, calibration.body_from_lidar, 0), calibration);
}

void add_points(const std::vector<FeaturePoint>& features, const Pose& pose, Cloud& cloud) {
  for (const FeaturePoint& feature : features) {
    pcl::PointNormal point;
    point.getVector3fMap() = (pose * feature.position.cast<double>()).cast<float>();
    point.getNormalVector3fMap() = (pose.rotation * feature.normal.cast<double>()).cast<float>();
    cloud.push_back(point);
  }
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Both start 5 cm and 0.5 degrees off and search as often as they need.
void BM_ScanToMap(benchmark::State& state) {
  RandomStream noise(1, "matcher bench");
  const testing::BoxWorld world = testing::pillared_hall(40.0);
  Calibration calibration;
  calibration.lidar_range_sigma_m = kRangeSigma_m;
  ScanMatcher matcher(calibration, {});
  const auto map = std::make_shared<Cloud>();
  const auto pose_of = [](int scan) { return Pose{Eigen::Quaterniond::Identity(), {kStep_m * scan, 0.0, 0.0}}; };
  for (int i = 0; i < kMappedScans; ++i) {
    const FeatureCloud features = scan_at(world, pose_of(i), calibration, noise);
    matcher.insert(features, pose_of(i), kStep_m * i);
    add_points(features.planes, pose_of(i), *map);
  }
  const Pose truth = pose_of(kMappedScans);
  const FeatureCloud features = scan_at(world, truth, calibration, noise);
  Vector6d off;
  off << 0.0, 0.0, 0.009, 0.05, 0.0, 0.0;
  const Pose guess = truth.retract(off);
  const auto source = std::make_shared<Cloud>();
  add_points(features.planes, guess, *source);

  double ours_s = 0.0;
  double pcl_s = 0.0;
  double ours_points = 0.0;
  for (auto _ : state) {
    const double start_s = cpu_seconds();
    // New points renew the trees, as they do in every scan of a run.
    matcher.insert(features, truth, kStep_m * kMappedScans);
    const SolveResult solved = matcher.match(features, {guess, 0.01 * Matrix6d::Identity()});
    ours_s += cpu_seconds() - start_s;
    ours_points += solved.features;

    const double pcl_start_s = cpu_seconds();
    pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> registration;
    registration.setInputSource(source);
    registration.setInputTarget(map);
    registration.setMaximumIterations(10);
    registration.setTransformationEpsilon(1e-8);
    registration.setMaxCorrespondenceDistance(1.0);
    Cloud aligned;
    registration.align(aligned);
    pcl_s += cpu_seconds() - pcl_start_s;
    benchmark::DoNotOptimize(aligned.points.data());
  }
  const double ours = ours_s / ours_points;
  const double pcl = pcl_s / (static_cast<double>(state.iterations()) * static_cast<double>(source->size()));
  state.counters["of_pcl"] = ours / pcl;
  state.counters["ms_per_1000"] = 1e6 * ours;
  state.counters["share_of_200_ms"] = ours_s / static_cast<double>(state.iterations()) / 0.2;
}
BENCHMARK(BM_ScanToMap)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumbline
