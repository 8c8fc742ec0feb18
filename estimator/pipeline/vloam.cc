#include "estimator/pipeline/vloam.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "estimator/lidar/deskew.h"
#include "estimator/lidar/features.h"

namespace plumbline {
namespace {

constexpr std::int64_t kTrackLength_ns = 500'000'000;
constexpr std::size_t kMaxWaiting = 64;
constexpr std::int64_t kMaxImuGap_ns = 500'000'000;

// A solution's rows share errors that whitening does not know: features of one key-frame share its depth errors over
// dozens of frames, points of neighbouring scans share the map's.
constexpr double kVisionInflation = 25.0;
constexpr double kLidarInflation = 25.0;

// The estimator stops believing its position when the filter's own standard deviation exceeds this [m].
constexpr double kLostSigma_m = 10.0;

class StopWatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool finite(const ImuSample& s) { return s.angular_rate.allFinite() && s.specific_force.allFinite(); }

ModuleMode mode_of(int well_conditioned) {
  if (well_conditioned == 6) return ModuleMode::kSolved;
  return well_conditioned == 0 ? ModuleMode::kBypassed : ModuleMode::kPartial;
}

/// Without an IMU its samples are a clock: no rate, no force, and "biases" free enough to be the motion itself, which
/// makes the mechanisation a constant-rate, constant-acceleration predictor.
ImuNoise clock_only() {
  ImuNoise noise;
  noise.gyro_random_walk = 3.0;
  noise.accel_random_walk = 20.0;
  noise.gyro_turn_on_sigma = 1.0;
  noise.accel_turn_on_sigma = 3.0;
  return noise;
}

Calibration effective(Calibration calibration, const EstimatorConfig& config) {
  if (!config.imu_enabled) calibration.imu = clock_only();
  return calibration;
}

}  // namespace

Vloam::Vloam(const Calibration& calibration, const EstimatorConfig& config, const VisionConfig& vision,
             const ScanMatcherConfig& matcher)
    : calibration_(effective(calibration, config)),
      config_(config),
      initializer_(calibration_),
      vision_(calibration_, vision, config.remapping),
      matcher_(calibration_, matcher, config.remapping) {}

void Vloam::add(const ImuSample& received) {
  ImuSample sample = received;
  if (!config_.imu_enabled) {
    sample.angular_rate.setZero();
    sample.specific_force.setZero();
    // Level at the start, by decree: there is nothing else to go by.
    if (!filter_) sample.specific_force.z() = kStandardGravity;
  }
  if (!finite(sample)) return drop(Module::kImu, "not finite");
  if (counts_[Module::kImu].used > 0 && sample.stamp_ns <= last_sample_.stamp_ns) {
    return drop(Module::kImu, "back in time");
  }
  ++counts_[Module::kImu].used;
  const ImuSample previous = std::exchange(last_sample_, sample);
  if (!filter_) {
    if (const auto start = initializer_.add(sample)) start_with(*start, sample);
  } else {
    InertialSegment segment = segment_between(previous, sample);
    // Over a gap the line between the samples is worth nothing.
    if (sample.stamp_ns - previous.stamp_ns > kMaxImuGap_ns) segment.rate_slope = segment.force_slope.setZero();
    while (!waiting_.empty() && waiting_.begin()->first <= sample.stamp_ns) {
      const auto next = waiting_.extract(waiting_.begin());
      advance_to(next.key(), segment);
      std::visit([this](const auto& message) { handle(message); }, next.mapped());
    }
    advance_to(sample.stamp_ns, segment);
  }
  outputs_.push_back(output(sample.stamp_ns));
  outputs_.back().health = std::exchange(health_, {});
}

void Vloam::start_with(const InitialState& start, const ImuSample& sample) {
  InitialState initial = start;
  if (!config_.imu_enabled) initial.state.accel_bias = Eigen::Vector3d(0.0, 0.0, -kStandardGravity);
  filter_.emplace(initial, calibration_.imu, config_.remapping);
  track_.push(sample.stamp_ns, initial.state.world_from_body);
  // What was measured before the start has no pose to stand on.
  while (!waiting_.empty() && waiting_.begin()->first <= sample.stamp_ns) {
    const bool is_scan = std::holds_alternative<LidarScan>(waiting_.begin()->second);
    drop(is_scan ? Module::kLidar : Module::kVision, "before the start");
    waiting_.erase(waiting_.begin());
  }
}

void Vloam::advance_to(std::int64_t stamp_ns, const InertialSegment& segment) {
  const std::int64_t now_ns = filter_->state().stamp_ns;
  if (stamp_ns <= now_ns) return;
  filter_->predict(segment.part(now_ns, stamp_ns));
  track_.push(stamp_ns, filter_->state().world_from_body);
  track_.forget_before(stamp_ns - kTrackLength_ns);
}

void Vloam::add(const CameraFrame& frame) {
  if (!config_.vision_enabled || !calibration_.has_camera) return drop(Module::kVision, "disabled");
  if (frame.camera_id != 0) return drop(Module::kVision, "further cameras are not used");
  const CameraIntrinsics& camera = calibration_.camera;
  const auto pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (frame.width != camera.width || frame.height != camera.height || frame.pixels.size() != pixels) {
    return drop(Module::kVision, "wrong size");
  }
  // Noise makes no two images alike: a driver that repeats one is stuck, and would swear that nothing moves.
  if (frame.pixels == last_pixels_) return drop(Module::kVision, "repeats the last");
  last_pixels_ = frame.pixels;
  hold(frame.stamp_ns, frame);
}

void Vloam::add(const DepthFrame&) { drop(Module::kVision, "depth images are not used"); }

void Vloam::add(const LidarScan& scan) {
  if (!calibration_.has_lidar) return drop(Module::kLidar, "disabled");
  if (scan.points.empty()) return drop(Module::kLidar, "empty");
  if (scan.end_ns <= scan.stamp_ns) return drop(Module::kLidar, "back in time");
  LidarScan finite_scan = scan;
  std::erase_if(finite_scan.points, [](const LidarPoint& point) { return !point.position.allFinite(); });
  if (finite_scan.points.empty()) return drop(Module::kLidar, "not finite");
  hold(scan.end_ns, std::move(finite_scan));
}

void Vloam::hold(std::int64_t stamp_ns, Exteroceptive message) {
  const Module module = std::holds_alternative<LidarScan>(message) ? Module::kLidar : Module::kVision;
  if (!filter_ && counts_[Module::kImu].used == 0) return drop(module, "before the start");
  if (filter_ && stamp_ns <= filter_->state().stamp_ns) {
    if (!track_.covers(stamp_ns)) return drop(module, "late");
    return std::visit([this](const auto& m) { handle(m); }, message);
  }
  if (waiting_.size() >= kMaxWaiting) return drop(module, "no IMU to go with");
  waiting_.emplace(stamp_ns, std::move(message));
}

void Vloam::handle(const CameraFrame& frame) {
  const StopWatch watch;
  ++counts_[Module::kVision].used;
  const Pose predicted = filter_->world_from_keyframe().inverse() * track_.at(frame.stamp_ns);
  const SolveResult solved = vision_.process(frame, {predicted, filter_->keyframe_motion_covariance()});
  correct([&] { filter_->update_keyframe_motion(solved, predicted, kVisionInflation); });
  if (vision_.wants_keyframe()) {
    const Pose world_from_body = track_.at(frame.stamp_ns);
    filter_->set_keyframe(world_from_body);
    vision_.start_keyframe(world_from_body);
  }
  report(frame.stamp_ns, Module::kVision, solved, predicted, watch.seconds());
}

void Vloam::handle(const LidarScan& scan) {
  // The first sweeps began before the start: no motion is known for their first points.
  if (!track_.covers(scan.stamp_ns) || !track_.covers(scan.end_ns)) return drop(Module::kLidar, "before the start");
  ++counts_[Module::kLidar].used;
  const StopWatch watch;
  const auto points_in_body = deskew(scan, track_, calibration_.body_from_lidar, scan.end_ns);
  if (config_.lidar_enabled) refine_with_scan(scan, points_in_body);

  const Pose world_from_body = track_.at(scan.end_ns);
  if (config_.vision_enabled) {
    const Eigen::Isometry3f transform =
        Eigen::Translation3f(world_from_body.translation.cast<float>()) * world_from_body.rotation.cast<float>();
    std::vector<Eigen::Vector3f> points_in_world;
    points_in_world.reserve(points_in_body.size());
    for (const Eigen::Vector3f& p : points_in_body) points_in_world.push_back(transform * p);
    vision_.add_depth_points(scan.end_ns, points_in_world);
  }
  if (!health_.empty() && health_.back().module == Module::kLidar) health_.back().processing_s = watch.seconds();
}

void Vloam::refine_with_scan(const LidarScan& scan, const std::vector<Eigen::Vector3f>& points_in_body) {
  const FeatureCloud features = extract_features(scan, points_in_body, calibration_);
  const Pose predicted = track_.at(scan.end_ns);
  const SolveResult solved = matcher_.match(features, {predicted, filter_->pose_covariance()});
  correct([&] { filter_->update_pose(solved, predicted, kLidarInflation); });
  const Pose world_from_body = track_.at(scan.end_ns);
  path_m_ += (world_from_body.translation - last_scan_position_).norm();
  last_scan_position_ = world_from_body.translation;
  matcher_.insert(features, world_from_body, path_m_);
  report(scan.end_ns, Module::kLidar, solved, predicted, 0.0);
}

template <typename Update>
void Vloam::correct(Update&& update) {
  const Pose before = filter_->state().world_from_body;
  update();
  track_.premultiply(filter_->state().world_from_body * before.inverse());
}

void Vloam::report(std::int64_t stamp_ns, Module module, const SolveResult& solved, const Pose& predicted,
                   double seconds) {
  ModuleHealth health;
  health.stamp_ns = stamp_ns;
  health.module = module;
  health.mode = mode_of(solved.spectrum.well_conditioned);
  health.eigenvalues = solved.spectrum.eigenvalues;
  health.eigenvectors = solved.spectrum.eigenvectors;
  health.well_conditioned = solved.spectrum.well_conditioned;
  health.rows = solved.features;
  health.inliers = solved.inliers;
  health.correction = predicted.local(solved.pose);
  health.processing_s = seconds;
  health_.push_back(health);
}

void Vloam::drop(Module module, const char* reason) { ++counts_[module].dropped[reason]; }

Odometry Vloam::output(std::int64_t stamp_ns) const {
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
  odometry.lost = odometry.covariance.bottomRightCorner<3, 3>().trace() > kLostSigma_m * kLostSigma_m ||
                  !state.world_from_body.translation.allFinite();
  return odometry;
}

std::vector<Odometry> Vloam::take() { return std::exchange(outputs_, {}); }

MessageCounts Vloam::counts(Module module) const {
  const auto found = counts_.find(module);
  return found == counts_.end() ? MessageCounts{} : found->second;
}

std::vector<TrackedFeature> Vloam::features() const {
  return config_.vision_enabled ? vision_.features() : std::vector<TrackedFeature>{};
}

std::vector<MapPoint> Vloam::map() const { return matcher_.map(); }

}  // namespace plumbline
