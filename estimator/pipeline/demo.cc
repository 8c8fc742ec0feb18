#include "estimator/pipeline/demo.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "estimator/lidar/deskew.h"
#include "estimator/lidar/features.h"
#include "estimator/pipeline/module_health.h"
#include "estimator/vision/corner_detector.h"

namespace plumbline {
namespace {

constexpr std::int64_t kOdometryTrack_ns = 3'000'000'000;
/// A scan waits for an image taken after its end; if none comes it makes do with constant velocity.
constexpr std::int64_t kLongestWait_ns = 200'000'000;
/// The rows of one image share errors that whitening does not know, such as those of the depth map.
constexpr double kImageInflation = 10.0;
/// What constant velocity foresees of the next image: see FrameToFrameConfig::degeneracy_threshold.
constexpr double kPredictionInformation = 2500.0;
/// Of a sweep's predicted pose besides the motion since the last one: the map's own.
constexpr double kMapRotationSigma = 0.002;
constexpr double kMapTranslationSigma_m = 0.02;
constexpr double kLost_s = 2.0;   // without any image or scan that could be solved
constexpr double kBlind_s = 0.3;  // without an image that could be solved: scans tell the velocity

FrameToFrameConfig vision_config(const EstimatorConfig& config, const DemoConfig& stages) {
  FrameToFrameConfig vision;
  vision.map_depth_only = stages.map_depth_only;
  vision.features_per_cell = features_of_share(vision.features_per_cell, config.feature_share);
  return vision;
}

WeakDirections weak_directions_of_stages(const EstimatorConfig& config, const DemoConfig& stages) {
  return stages.constant_prior ? WeakDirections::kPulled : weak_directions(config.remapping);
}

MessageUse clocked_use(const Calibration& calibration, EstimatorConfig config) {
  config.imu_enabled = false;
  return message_use(calibration, config);
}

Matrix6d step_covariance(const FrameToFrame::Step& step) {
  const Matrix6d prior = kPredictionInformation * Matrix6d::Identity();
  const Matrix6d information = step.skipped ? prior : Matrix6d(step.solved.information + prior);
  return kImageInflation * information.ldlt().solve(Matrix6d::Identity());
}

}  // namespace

Demo::Demo(const Calibration& calibration, const EstimatorConfig& config, const DemoConfig& stages)
    : calibration_(calibration),
      config_(config),
      stages_(stages),
      gate_(clocked_use(calibration, config)),
      vision_(calibration, vision_config(config, stages), weak_directions_of_stages(config, stages)),
      sweeps_(calibration, weak_directions_of_stages(config, stages)),
      matcher_(calibration, {.resolution_factor = config.resolution_factor},
               weak_directions_of_stages(config, stages)) {
  stages_.scan_matching = stages.scan_matching && config.lidar_enabled;
  stages_.sweep_refinement = stages.sweep_refinement && config.lidar_enabled;
}

void Demo::add(const ImuSample& received) {
  const std::optional<ImuSample> tick = gate_.admit(received);
  if (!tick) return;
  while (const auto message = gate_.next(tick->stamp_ns)) {
    std::visit([this](const auto& payload) { handle(payload); }, *message);
  }
  use_scans(tick->stamp_ns);
  outputs_.push_back(output(tick->stamp_ns));
  outputs_.back().health = std::exchange(health_, {});
}

void Demo::add(const CameraFrame& frame) { gate_.admit(frame); }
void Demo::add(const DepthFrame& frame) { gate_.admit(frame); }
void Demo::add(const LidarScan& scan) { gate_.admit(scan); }
void Demo::add(const PointFrame& frame) { gate_.admit(frame); }

void Demo::handle(const CameraFrame& frame) { see(frame); }
void Demo::handle(const PointFrame& frame) { see(frame); }

template <typename Frame>
void Demo::see(const Frame& frame) {
  const StopWatch watch;
  if (frame.camera_id != 0) {
    gate_.count_used(Module::kVision);
    return vision_.add_stereo(frame);
  }
  if (!odometry_.empty() && frame.stamp_ns <= odometry_.last_ns()) return gate_.drop(Module::kVision, "late");
  gate_.count_used(Module::kVision);
  const bool has_previous = vision_.started();
  const std::int64_t previous_ns = vision_.newest_ns();
  const FrameToFrame::Step step = vision_.process(frame);
  odometry_.push(frame.stamp_ns, vision_.odometry_from_body());
  odometry_.forget_before(frame.stamp_ns - kOdometryTrack_ns);
  if (has_previous) note(step, previous_ns);
  use_scans(frame.stamp_ns);
  adjust_when_due();
  health_.push_back(health_of(frame.stamp_ns, Module::kVision, step.solved, step.predicted, watch.seconds()));
}

void Demo::handle(const DepthFrame& frame) {
  gate_.count_used(Module::kVision);
  if (vision_.started()) vision_.add_depth_image(frame);
}

void Demo::handle(const LidarScan& scan) { scans_.push_back(scan); }

void Demo::note(const FrameToFrame::Step& step, std::int64_t previous_ns) {
  const std::int64_t newest_ns = vision_.newest_ns();
  const Pose motion = odometry_.at(previous_ns).inverse() * odometry_.at(newest_ns);
  covariance_.carry(motion, step_covariance(step), seconds_between(previous_ns, newest_ns));
  if (step.skipped) return;
  solved_ns_ = newest_ns;
  fixed_ns_ = std::max(fixed_ns_, newest_ns);
  ++images_;
}

/// Every fifth image that was solved joins the window; a full window is refined, and its last image starts the next.
void Demo::adjust_when_due() {
  if (!stages_.bundle_adjustment || !vision_.started()) return;
  const bool solved = bundle_.empty() || solved_ns_ == vision_.newest_ns();
  if (!solved || images_ % bundle_config_.image_stride != 0) return;
  bundle_.push_back({vision_.odometry_from_body(), vision_.inliers()});
  if (bundle_.size() < static_cast<std::size_t>(bundle_config_.window_images)) return;
  const Pose& first = bundle_.front().odometry_from_body;
  if (const auto first_from_body = adjust_bundle(bundle_, calibration_, bundle_config_)) {
    integration_.refine(integration_.world_from_body(first) * first_from_body->back(),
                        bundle_.back().odometry_from_body);
  }
  bundle_.erase(bundle_.begin(), bundle_.end() - 1);
}

void Demo::use_scans(std::int64_t now_ns) {
  while (!scans_.empty()) {
    const std::int64_t end_ns = scans_.front().end_ns;
    const bool covered = !odometry_.empty() && end_ns <= odometry_.last_ns();
    if (!covered && now_ns < end_ns + kLongestWait_ns) return;
    if (!covered) go_on_without_images(scans_.front());
    const LidarScan scan = std::move(scans_.front());
    scans_.pop_front();
    use(scan);
  }
}

/// A scan that no image has followed is placed where the motion leads that was known last, at first none.
void Demo::go_on_without_images(const LidarScan& scan) {
  if (!vision_.started()) {
    if (!stages_.scan_matching && !stages_.sweep_refinement) return;
    odometry_.push(scan.stamp_ns, {});
    vision_.go_on(scan.stamp_ns, Vector6d::Zero());
  }
  odometry_.push(scan.end_ns, vision_.predicted(scan.end_ns));
  covariance_.carry(odometry_.at(scan.stamp_ns).inverse() * odometry_.at(scan.end_ns),
                    kImageInflation / kPredictionInformation * Matrix6d::Identity(),
                    seconds_between(scan.stamp_ns, scan.end_ns));
}

void Demo::use(const LidarScan& received) {
  // No motion is known before the first image.
  if (!odometry_.covers(received.stamp_ns) || !odometry_.covers(received.end_ns)) {
    return gate_.drop(Module::kLidar, "before the start");
  }
  gate_.count_used(Module::kLidar);
  const LidarScan scan = matcher_.range_biases().taken_off(received);
  const DeskewedScan deskewed = deskew(scan, odometry_, calibration_.body_from_lidar, scan.end_ns);
  vision_.add_depth_points(scan.end_ns, deskewed.points, odometry_.at(scan.end_ns));
  if (stages_.sweep_refinement) return refine_with_sweep(scan);
  if (!stages_.scan_matching) return;
  const StopWatch watch;
  const FeatureCloud features = extract_features(scan, deskewed, calibration_);
  match(features, scan.end_ns, integration_.world_from_body(odometry_.at(scan.end_ns)), watch.seconds());
}

void Demo::refine_with_sweep(const LidarScan& part) {
  const StopWatch watch;
  const auto sweep = sweeps_.add(part, odometry_, covariance_against_map());
  if (!sweep) return;
  if (sweep->solved.features > 0) {
    health_.push_back(health_of(sweep->end_ns, Module::kLidar, sweep->solved, sweep->solved.pose, watch.seconds()));
  }
  match(sweep->features, sweep->end_ns, world_from_last_match_ * sweep->last_end_from_end, 0.0);
}

/// @param predicted  world_from_body at the features' time
/// @param seconds  already spent on them
void Demo::match(const FeatureCloud& features, std::int64_t stamp_ns, const Pose& predicted, double seconds) {
  const StopWatch watch;
  const SolveResult solved = matcher_.match(features, {predicted, covariance_against_map()});
  integration_.refine(solved.pose, odometry_.at(stamp_ns));
  const std::int64_t last_ns = std::exchange(match_ns_, stamp_ns);
  if (last_ns != 0 && seconds_between(solved_ns_, stamp_ns) > kBlind_s) {
    vision_.go_on(stamp_ns, world_from_last_match_.local(solved.pose) / seconds_between(last_ns, stamp_ns));
  }
  const Eigen::Vector3d step_in_body =
      solved.pose.rotation.conjugate() * (solved.pose.translation - world_from_last_match_.translation);
  path_m_ += step_in_body.norm();
  world_from_last_match_ = solved.pose;
  matcher_.insert(features, solved.pose, path_m_);
  matcher_.learn_range_biases(step_in_body.norm());
  covariance_.match(solved, matcher_.drift(), step_in_body);
  if (solved.spectrum.well_conditioned == 6) fixed_ns_ = std::max(fixed_ns_, stamp_ns);
  health_.push_back(health_of(stamp_ns, Module::kLidar, solved, predicted, seconds + watch.seconds()));
}

Matrix6d Demo::covariance_against_map() const {
  Matrix6d covariance = covariance_.since_match();
  covariance.diagonal().head<3>().array() += kMapRotationSigma * kMapRotationSigma;
  covariance.diagonal().tail<3>().array() += kMapTranslationSigma_m * kMapTranslationSigma_m;
  return covariance;
}

Odometry Demo::output(std::int64_t stamp_ns) {
  Odometry odometry;
  odometry.stamp_ns = stamp_ns;
  if (!vision_.started()) return odometry;
  odometry.world_from_body = integration_.world_from_body(vision_.predicted(stamp_ns));
  const double since_image_s = std::max(0.0, seconds_between(vision_.newest_ns(), stamp_ns));
  odometry.covariance = covariance_.of_world() + since_image_s * covariance_.per_s();
  const double since_output_s = output_ns_ == 0 ? 0.0 : seconds_between(output_ns_, stamp_ns);
  odometry.increment_covariance = since_output_s * covariance_.per_s();
  output_ns_ = stamp_ns;
  const bool drifted = lost_.lost(odometry);
  odometry.lost = drifted || (fixed_ns_ != 0 && seconds_between(fixed_ns_, stamp_ns) > kLost_s);
  return odometry;
}

std::vector<Odometry> Demo::take() { return std::exchange(outputs_, {}); }
MessageCounts Demo::counts(Module module) const { return gate_.counts(module); }
std::vector<TrackedFeature> Demo::features() const { return vision_.features(); }
std::vector<MapPoint> Demo::map() const { return matcher_.map(); }

}  // namespace plumbline
