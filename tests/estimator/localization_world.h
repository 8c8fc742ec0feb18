#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "estimator/lidar/deskew.h"
#include "estimator/localization/localized_estimator.h"
#include "tests/support/box_world.h"

/// Runs of the localization without a simulator: closed-form scans, and an odometry whose drift is given.
namespace plumbline::testing {

inline constexpr std::int64_t kImuPeriod_ns = 5'000'000;
inline constexpr int kSamplesPerScan = 20;

inline Calibration lidar_calibration() {
  Calibration c;
  c.has_camera = false;
  c.lidar_range_sigma_m = kRangeSigma;
  c.body_from_lidar.translation = {0.1, 0.0, 0.15};
  return c;
}

/// Along x at 1 m/s, swaying and turning a little.
inline Pose stroll(double t) {
  return {rotation_from_rpy({0.01 * std::sin(5.0 * t), 0.01 * std::sin(4.0 * t), 0.1 * std::sin(0.5 * t)}),
          {t, 0.3 * std::sin(0.4 * t), 0.02 * std::sin(6.0 * t)}};
}

/// Says exactly where the body is, moved by a drift: drift(t) is odometry_from_world.
class DriftingOdometry final : public Estimator {
 public:
  DriftingOdometry(Motion world_from_body, Motion drift)
      : truth_(std::move(world_from_body)), drift_(std::move(drift)) {}

  void add(const ImuSample& sample) override {
    const double t = 1e-9 * static_cast<double>(sample.stamp_ns);
    Odometry output;
    output.stamp_ns = sample.stamp_ns;
    output.world_from_body = drift_(t) * truth_(t);
    outputs_.push_back(output);
  }
  void add(const CameraFrame&) override {}
  void add(const DepthFrame&) override {}
  void add(const LidarScan&) override {}
  std::vector<Odometry> take() override { return std::exchange(outputs_, {}); }
  MessageCounts counts(Module) const override { return {}; }

 private:
  Motion truth_;
  Motion drift_;
  std::vector<Odometry> outputs_;
};

/// What scans from every half metre of a straight walk see, in the world's frame.
inline PriorMap mapped_along_x(const BoxWorld& world, double to_m, bool with_normals = true, double from_m = 0.0) {
  const Calibration c = lidar_calibration();
  RandomStream noise(77, "map");
  PriorMapBuilder builder(with_normals);
  PoseTrack rest;
  rest.push(0, {});
  for (double x = from_m; x <= to_m; x += 0.5) {
    const Pose pose{Eigen::Quaterniond::Identity(), {x, 0.2 * std::sin(x), 0.05 * std::sin(3.0 * x)}};
    const LidarScan scan = vlp16_scan(
        world, [&](double) { return pose; }, 0, c.body_from_lidar, kRangeSigma, noise);
    const FeatureCloud features = extract_features(scan, deskew(scan, rest, c.body_from_lidar, 0), c);
    for (const auto* kind : {&features.planes, &features.edges}) {
      for (const FeaturePoint& f : *kind) {
        builder.add(pose * f.position.cast<double>(), (pose.rotation.cast<float>() * f.normal).eval(), f.intensity);
      }
    }
  }
  return builder.build();
}

struct LocalizedRun {
  std::vector<Odometry> outputs;
  std::vector<MapMatch> matches;
  std::vector<ModuleHealth> health;
};

/// The body at rest for the first two seconds' worth of the motion's start would hide drift, so it moves at once.
inline LocalizedRun run_localized(const BoxWorld& world, const PriorMap& map, const Motion& motion, const Motion& drift,
                                  double duration_s, const LocalizationConfig& config = {}) {
  LocalizedEstimator estimator(std::make_unique<DriftingOdometry>(motion, drift), lidar_calibration(), map, config);
  RandomStream noise(5, "lidar");
  LocalizedRun run;
  const auto samples = static_cast<std::int64_t>(200.0 * duration_s);
  for (std::int64_t k = 0; k <= samples; ++k) {
    ImuSample sample;
    sample.stamp_ns = k * kImuPeriod_ns;
    estimator.add(sample);
    for (Odometry& output : estimator.take()) {
      run.matches.insert(run.matches.end(), output.map_matches.begin(), output.map_matches.end());
      run.health.insert(run.health.end(), output.health.begin(), output.health.end());
      run.outputs.push_back(std::move(output));
    }
    if (k == 0 || k % kSamplesPerScan != 0) continue;
    const std::int64_t start_ns = (k - kSamplesPerScan) * kImuPeriod_ns;
    estimator.add(vlp16_scan(world, motion, start_ns, lidar_calibration().body_from_lidar, kRangeSigma, noise));
  }
  return run;
}

inline double position_error(const Odometry& output, const Motion& truth) {
  const double t = 1e-9 * static_cast<double>(output.stamp_ns);
  return (output.world_from_body.translation - truth(t).translation).norm();
}

}  // namespace plumbline::testing
