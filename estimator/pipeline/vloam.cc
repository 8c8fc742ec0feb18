#include "estimator/pipeline/vloam.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/lidar/deskew.h"
#include "estimator/lidar/features.h"
#include "estimator/pipeline/module_health.h"
#include "estimator/vision/corner_detector.h"

namespace plumbline {
namespace {

constexpr std::int64_t kTrackLength_ns = MessageGate::kLongestDelay_ns + SweepAssembler::kLongest_ns;
constexpr std::int64_t kTurnTrackLength_ns = 3'000'000'000;  // longer than a key-frame lasts while its tracks do

// A solution's rows share errors that whitening does not know. Those of vision, hundredths of a pixel that tracks and
// depths of one scene have in common, keep their sign over many key-frames: the images of a second together say no more
// than one of them. (Errors of the turn against the truth lasted from one to several seconds.)
constexpr double kVisionMemory_s = 1.0;
// Those of scan matching are the map's (see InertialFilter and MatchDrift).
constexpr double kLidarInflation = 1.0;

VisionConfig vision_config(const EstimatorConfig& config) {
  VisionConfig vision;
  vision.features_per_cell = features_of_share(vision.features_per_cell, config.feature_share);
  return vision;
}

}  // namespace

Vloam::Vloam(const Calibration& calibration, const EstimatorConfig& config, Coupling coupling)
    : calibration_(calibration),
      config_(config),
      coupling_(coupling),
      gate_(message_use(calibration_, config)),
      initializer_(calibration_),
      vision_(calibration_, vision_config(config), weak_directions(config.remapping)),
      matcher_(calibration_, {.resolution_factor = config.resolution_factor}, weak_directions(config.remapping)) {}

void Vloam::add(const ImuSample& received) {
  const std::optional<ImuSample> sample = gate_.admit(received);
  if (!sample) return;
  const ImuSample previous = std::exchange(last_sample_, *sample);
  if (!filter_) {
    if (const auto start = initializer_.add(*sample)) start_with(*start, *sample);
  } else {
    InertialSegment segment = segment_between(previous, *sample);
    if (sample->stamp_ns - previous.stamp_ns > kMaxImuGap_ns) segment.rate_slope = segment.force_slope.setZero();
    while (const auto message = gate_.next(sample->stamp_ns)) {
      advance_to(stamp_of(*message), segment);
      handle(*message);
    }
    advance_to(sample->stamp_ns, segment);
  }
  if (filter_) increments_.update(*filter_, track_);
  outputs_.push_back(output(sample->stamp_ns));
  outputs_.back().increment_covariance =
      filter_ ? increments_.covariance(seconds_between(previous.stamp_ns, sample->stamp_ns))
              : initializer_.increment_covariance();
  outputs_.back().health = std::exchange(health_, {});
}

void Vloam::start_with(const InitialState& start, const ImuSample& sample) {
  filter_.emplace(start, calibration_.imu, config_.remapping);
  track_.push(sample.stamp_ns, start.state.world_from_body);
  turn_track_.push(sample.stamp_ns, {});
  keyframe_ns_ = sample.stamp_ns;
  last_image_ns_ = sample.stamp_ns;
  increments_.start_at(sample.stamp_ns);
  gate_.start_at(sample.stamp_ns);
}

void Vloam::advance_to(std::int64_t stamp_ns, const InertialSegment& segment) {
  const std::int64_t now_ns = filter_->state().stamp_ns;
  if (stamp_ns <= now_ns) return;
  const Eigen::Quaterniond before = filter_->state().world_from_body.rotation;
  filter_->predict(segment.part(now_ns, stamp_ns));
  track_.push(stamp_ns, filter_->state().world_from_body);
  track_.forget_before(stamp_ns - kTrackLength_ns);
  turned_ = (turned_ * before.conjugate() * filter_->state().world_from_body.rotation).normalized();
  turn_track_.push(stamp_ns, {turned_, Eigen::Vector3d::Zero()});
  turn_track_.forget_before(stamp_ns - kTurnTrackLength_ns);
}

template <typename Payload>
void Vloam::take_in(const Payload& payload) {
  gate_.admit(payload);
  if (!filter_) return;
  while (const auto message = gate_.next(filter_->state().stamp_ns)) handle(*message);
}

void Vloam::add(const CameraFrame& frame) { take_in(frame); }
void Vloam::add(const DepthFrame& frame) { take_in(frame); }
void Vloam::add(const LidarScan& scan) { take_in(scan); }
void Vloam::add(const PointFrame& frame) { take_in(frame); }

void Vloam::handle(const MessageGate::Message& message) {
  std::visit([this](const auto& payload) { handle(payload); }, message);
}

void Vloam::handle(const CameraFrame& frame) { see(frame); }
void Vloam::handle(const PointFrame& frame) { see(frame); }

template <typename Frame>
void Vloam::see(const Frame& frame) {
  if (!track_.covers(frame.stamp_ns)) return gate_.drop(Module::kVision, "before the start");
  const StopWatch watch;
  gate_.count_used(Module::kVision);
  if (frame.camera_id != 0) return vision_.add_stereo(frame);
  const Pose predicted = filter_->world_from_keyframe().inverse() * track_.at(frame.stamp_ns);
  const PosePrior prior{predicted, filter_->keyframe_motion_covariance()};
  if (coupling_ == Coupling::kJoint) {
    if (vision_.follow(frame, prior)) {
      followed_ns_ = frame.stamp_ns;
    } else {
      start_keyframe_when_due(frame.stamp_ns);
    }
    return;
  }
  const SolveResult solved = vision_.process(frame, prior);
  correct([&] { filter_->update_keyframe_motion(solved, predicted, vision_inflation(frame.stamp_ns)); });
  start_keyframe_when_due(frame.stamp_ns);
  report(frame.stamp_ns, Module::kVision, solved, predicted, watch.seconds());
}

double Vloam::vision_inflation(std::int64_t image_ns) {
  const std::int64_t last_ns = std::exchange(last_image_ns_, image_ns);
  return std::max(1.0, kVisionMemory_s / std::max(1e-3, seconds_between(last_ns, image_ns)));
}

void Vloam::start_keyframe_when_due(std::int64_t image_ns) {
  if (!vision_.wants_keyframe()) return;
  const Pose world_from_body = track_.at(image_ns);
  const Eigen::Quaterniond turn = turn_track_.at(keyframe_ns_).rotation.conjugate() * turn_track_.at(image_ns).rotation;
  filter_->set_keyframe(world_from_body);
  vision_.start_keyframe(world_from_body, turn);
  keyframe_ns_ = image_ns;
}

void Vloam::handle(const DepthFrame& frame) {
  if (!track_.covers(frame.stamp_ns)) return gate_.drop(Module::kVision, "before the start");
  gate_.count_used(Module::kVision);
  vision_.add_depth_image(frame, track_.at(frame.stamp_ns));
}

void Vloam::handle(const LidarScan& received) {
  // The first sweeps began before the start: no motion is known for their first points.
  if (!track_.covers(received.stamp_ns) || !track_.covers(received.end_ns))
    return gate_.drop(Module::kLidar, "before the start");
  gate_.count_used(Module::kLidar);
  const StopWatch watch;
  const LidarScan scan = matcher_.range_biases().taken_off(received);
  // What is matched corrects the state as it is now, so that a scan that came late is brought here by the motion since.
  const std::int64_t now_ns = filter_->state().stamp_ns;
  const DeskewedScan deskewed = deskew(scan, track_, calibration_.body_from_lidar, now_ns);
  if (config_.lidar_enabled) {
    const std::optional<LidarScan> sweep = sweeps_.add(scan);
    const bool in_parts = sweep && sweep->points.size() != scan.points.size();
    if (in_parts && track_.covers(sweep->stamp_ns)) {
      refine_with_scan(*sweep, deskew(*sweep, track_, calibration_.body_from_lidar, now_ns));
    } else if (sweep && !in_parts) {
      refine_with_scan(scan, deskewed);
    }
  }

  const Pose world_from_body = track_.at(now_ns);
  if (config_.vision_enabled) vision_.add_depth_points(scan.end_ns, deskewed.points, world_from_body);
  if (!health_.empty() && health_.back().module == Module::kLidar) health_.back().processing_s = watch.seconds();
}

/// Matches a scan to the map; in the joint problem, with the rows of the newest image, whose body stood a little before
/// the present one.
SolveResult Vloam::match(const FeatureCloud& features, const Pose& map_from_body) {
  const PosePrior prior{map_from_body, filter_->map_from_body_covariance()};
  const auto image_ns = std::exchange(followed_ns_, std::nullopt);
  if (!image_ns || !track_.covers(*image_ns)) return matcher_.match(features, prior);
  const Pose world_from_body = track_.at(filter_->state().stamp_ns);
  const Pose body_from_image = world_from_body.inverse() * track_.at(*image_ns);
  const Matrix6d d_image_d_body = adjoint(body_from_image.inverse());
  const Pose keyframe_from_map = filter_->world_from_keyframe().inverse() * world_from_body * map_from_body.inverse();
  int image_features = 0;
  SolveResult solved = matcher_.match(features, prior, [&](const Pose& pose, ResidualRows& rows) {
    ResidualRows of_image;
    vision_.linearize(keyframe_from_map * pose * body_from_image, of_image);
    image_features = of_image.feature_count();
    rows.append(of_image, d_image_d_body);
  });
  if (solved.spectrum.well_conditioned > 0) {
    vision_.settle(keyframe_from_map * solved.pose * body_from_image,
                   {solved.weights.end() - image_features, solved.weights.end()});
  }
  return solved;
}

void Vloam::refine_with_scan(const LidarScan& scan, const DeskewedScan& deskewed) {
  const FeatureCloud features = extract_features(scan, deskewed, calibration_);
  const Pose predicted = filter_->map_from_body();
  const std::optional<std::int64_t> image_ns = followed_ns_;
  const SolveResult solved = match(features, predicted);
  correct([&] { filter_->update_pose(solved, predicted, kLidarInflation); });
  if (image_ns) start_keyframe_when_due(*image_ns);
  const Pose world_from_body = track_.at(filter_->state().stamp_ns);
  const Eigen::Vector3d step_in_world = world_from_body.translation - last_scan_position_;
  path_m_ += step_in_world.norm();
  last_scan_position_ = world_from_body.translation;
  matcher_.insert(features, filter_->map_from_body(), path_m_, world_from_body);
  renew_map(world_from_body.rotation.conjugate() * step_in_world);
  report(scan.end_ns, Module::kLidar, solved, predicted, 0.0);
}

void Vloam::renew_map(const Eigen::Vector3d& step_in_body) {
  if (!std::exchange(has_map_, true)) return filter_->renew_map(1.0, Matrix6d::Zero());
  const MatchDrift& drift = matcher_.drift();
  if (drift.reach_m <= 0.0) return;
  filter_->renew_map(std::min(1.0, step_in_body.norm() / drift.reach_m), drift.covariance(step_in_body));
  matcher_.learn_range_biases(step_in_body.norm());
}

template <typename Update>
void Vloam::correct(Update&& update) {
  const Pose before = filter_->state().world_from_body;
  update();
  track_.premultiply(filter_->state().world_from_body * before.inverse());
}

void Vloam::report(std::int64_t stamp_ns, Module module, const SolveResult& solved, const Pose& predicted,
                   double seconds) {
  health_.push_back(health_of(stamp_ns, module, solved, predicted, seconds));
}

Odometry Vloam::output(std::int64_t stamp_ns) {
  Odometry odometry;
  odometry.stamp_ns = stamp_ns;
  if (!filter_) {
    odometry.world_from_body = initializer_.attitude();
    return odometry;
  }
  const NavigationState& state = filter_->state();
  odometry.world_from_body = state.world_from_body;
  odometry.velocity_in_world = state.velocity_in_world;
  odometry.gyro_bias = state.gyro_bias;
  odometry.accel_bias = state.accel_bias;
  odometry.covariance = filter_->pose_covariance();
  odometry.lost = lost_.lost(odometry);
  return odometry;
}

std::vector<Odometry> Vloam::take() { return std::exchange(outputs_, {}); }

MessageCounts Vloam::counts(Module module) const { return gate_.counts(module); }

std::vector<TrackedFeature> Vloam::features() const {
  return config_.vision_enabled ? vision_.features() : std::vector<TrackedFeature>{};
}

std::vector<MapPoint> Vloam::map() const { return matcher_.map(); }

}  // namespace plumbline
