#include "estimator/pipeline/loam.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/lidar/deskew.h"
#include "estimator/lidar/features.h"
#include "estimator/pipeline/module_health.h"

namespace plumbline {
namespace {

constexpr std::int64_t kSweepTrack_ns = 3'000'000'000;  // the sweep before, the growing one and a late arrival

// A solution's rows share errors that whitening does not know: the map's, or the last sweep's.
constexpr double kSweepInflation = 25.0;
constexpr int kFirstSweepRounds = 3;
constexpr int kFirstEffort = 6;
// A carrier does not jump: beyond so many sigma of what steady motion foresees, neighbours were mistaken.
constexpr double kLargestSurprise = 4.0;
constexpr int kMatchedClutter = 2500;  // a sweep of a second sees more of it

// Where the lidar alone tells the pose, odometry may be wrong by this much when it comes to matching with the map.
constexpr double kOdometrySigma_m = 0.1;
constexpr double kOdometrySigma_rad = 0.02;
constexpr double kBentDoubt = 2.0;               // times as wrong, where the sweep was bent
constexpr double kReadAttitudeSigma_rad = 1e-6;  // attitude that is read is beyond correction

MessageUse use_of(const Calibration& calibration, ImuUse imu) {
  MessageUse use;
  use.lidar = true;
  use.own_body = OwnBodyMask(calibration);
  use.imu = imu != ImuUse::kNone;
  return use;
}

ScanMatcherConfig scan_matcher_config(const EstimatorConfig& config) {
  ScanMatcherConfig matcher;
  matcher.resolution_factor = config.resolution_factor;
  matcher.largest_plane_disagreement = 1.0;
  matcher.clutter_budget = kMatchedClutter;
  return matcher;
}

}  // namespace

Loam::Loam(const Calibration& calibration, const EstimatorConfig& config, ImuUse imu)
    : calibration_(calibration),
      imu_(imu),
      mapping_(config.lidar_enabled),
      remapping_(config.remapping),
      gate_(use_of(calibration, imu)),
      initializer_(calibration),
      odometry_(calibration, weak_directions(config.remapping)),
      matcher_(calibration, scan_matcher_config(config), weak_directions(config.remapping)),
      bends_(imu == ImuUse::kNone) {}

void Loam::add(const ImuSample& received) {
  const std::optional<ImuSample> admitted = gate_.admit(received);
  if (!admitted) return;
  const ImuSample& sample = *admitted;
  const ImuSample previous = std::exchange(last_sample_, sample);
  if (!started()) {
    if (const auto start = start_from(sample)) start_with(*start);
  } else {
    InertialSegment segment = segment_between(previous, sample);
    if (sample.stamp_ns - previous.stamp_ns > kMaxImuGap_ns) segment.rate_slope = segment.force_slope.setZero();
    while (const auto message = gate_.next(sample.stamp_ns)) {
      advance_to(stamp_of(*message), segment);
      handle(std::get<LidarScan>(*message));
    }
    advance_to(sample.stamp_ns, segment);
  }
  if (filter_) increments_.update(*filter_, track_);
  outputs_.push_back(output(sample.stamp_ns));
  outputs_.back().increment_covariance = increment_covariance(seconds_between(previous.stamp_ns, sample.stamp_ns));
  outputs_.back().health = std::exchange(health_, {});
}

std::optional<InitialState> Loam::start_from(const ImuSample& sample) {
  // Level by decree: there is nothing else to go by.
  if (imu_ != ImuUse::kNone) return initializer_.add(sample);
  InitialState level;
  level.state.stamp_ns = sample.stamp_ns;
  return level;
}

void Loam::start_with(const InitialState& start) {
  if (imu_ == ImuUse::kFull) {
    filter_.emplace(start, calibration_.imu, remapping_);
    increments_.start_at(start.state.stamp_ns);
  } else {
    steady_.emplace(start.state, imu_ == ImuUse::kNone);
    start_ns_ = start.state.stamp_ns;
  }
  track_.push(start.state.stamp_ns, start.state.world_from_body);
  gate_.start_at(start.state.stamp_ns);
}

void Loam::advance_to(std::int64_t stamp_ns, const InertialSegment& segment) {
  const std::int64_t now_ns = state().stamp_ns;
  if (stamp_ns <= now_ns) return;
  const InertialSegment part = segment.part(now_ns, stamp_ns);
  if (filter_) filter_->predict(part);
  if (steady_) steady_->predict(part);
  track_.push(stamp_ns, state().world_from_body);
  track_.forget_before(stamp_ns - kSweepTrack_ns);
}

void Loam::add(const LidarScan& scan) {
  gate_.admit(scan);
  if (!started()) return;
  while (const auto message = gate_.next(state().stamp_ns)) handle(std::get<LidarScan>(*message));
}

void Loam::handle(const LidarScan& received) {
  // Of a scan that began before the start no motion is known, unless none is known at all.
  const bool known = track_.covers(received.end_ns) && (imu_ == ImuUse::kNone || track_.covers(received.stamp_ns));
  if (!known) return gate_.drop(Module::kLidar, "before the start");
  gate_.count_used(Module::kLidar);
  const StopWatch watch;
  const LidarScan part = matcher_.range_biases().taken_off(received);
  const std::optional<LidarScan> sweep = assembler_.add(part);
  const std::int64_t now_ns = newest_return_ns(part);
  const bool sees = !part.points.empty();  // otherwise it only ends its sweep
  if (sees && newest_ns_ != 0) part_s_ = std::max(0.0, seconds_between(newest_ns_, now_ns));
  if (sees) newest_ns_ = now_ns;
  if (now_ns - odometry_.reference_ns() > SweepOdometry::kLongestSilence_ns)
    odometry_ = SweepOdometry(calibration_, weak_directions(remapping_));
  if (growing_ && *growing_ != part.sweep) odometry_.discard();  // its end never came
  growing_ = part.sweep;
  if (sees && odometry_.begun() && now_ns > odometry_.reference_ns()) follow(part, now_ns);
  if (sweep) growing_.reset();
  if (sweep) finish({*sweep, newest_return_ns(*sweep), sweep->stamp_ns != part.stamp_ns});
  if (!health_.empty() && sweep) health_.back().processing_s = watch.seconds();
}

/// Odometry within the growing sweep.
void Loam::follow(const LidarScan& part, std::int64_t now_ns) {
  FeatureCloud features = features_of(part, track_, now_ns);
  const Pose predicted = predicted_motion(now_ns);
  const auto later_s = static_cast<float>(seconds_between(odometry_.reference_ns(), part.stamp_ns));
  move(features, predicted, later_s);
  odometry_.add(features);
  const Pose onwards = correction(now_ns) * predicted;
  const PosePrior prior{predicted, motion_covariance(now_ns)};
  motion_ = odometry_.solve(now_ns, prior, onwards, effort());
  // Not the turn: attitude that is read has no play at all.
  const double surprise_m = predicted.local(motion_.pose).tail<3>().norm();
  const double sigma_m = std::sqrt(prior.covariance.bottomRightCorner<3, 3>().trace() / 3.0);
  if (steady_ && surprise_m > kLargestSurprise * sigma_m) {
    motion_ = {};
    motion_.pose = onwards;
  }
  followed_ns_ = now_ns;
}

void Loam::finish(const Sweep& sweep) {
  const std::int64_t middle_ns = sweep.scan.stamp_ns + (sweep.end_ns - sweep.scan.stamp_ns) / 2;
  if (!odometry_.begun()) {
    first_ = sweep;
    if (last_end_ns_ != 0) carry_covariance(sweep.end_ns, Matrix6d::Zero());  // sweeps in between were lost
    FeatureCloud features = features_of(sweep.scan, track_, sweep.end_ns);
    return begin_sweep(std::move(features), middle_ns, sweep.end_ns,
                       track_.at(middle_ns).inverse() * track_.at(sweep.end_ns));
  }
  if (followed_ns_ != sweep.end_ns) return odometry_.discard();
  if (first_) redo_first_sweep();
  // Of a sweep in parts the whole is taken up anew: across all its lines normals reach further.
  FeatureCloud features = sweep.in_parts
                              ? features_of(sweep.scan, corrected_track(), sweep.end_ns)
                              : odometry_.corrected(sweep.end_ns, predicted_motion(sweep.end_ns), motion_.pose);
  PoseTrack within = corrected_track();
  carry_covariance(sweep.end_ns, motion_.information / kSweepInflation);
  take_motion(sweep.end_ns);
  match(features, sweep.end_ns);
  const bool slow = seconds_between(sweep.scan.stamp_ns, sweep.end_ns) > SweepBends::kLeastSweep_s;
  if (slow && sweep.in_parts && steady_ && mapping_) {
    within = bent(sweep, features, within);
    features = features_of(sweep.scan, within, sweep.end_ns);
  }
  lay_down(features, sweep.end_ns);
  begin_sweep(std::move(features), middle_ns, sweep.end_ns, within.at(middle_ns).inverse() * within.at(sweep.end_ns));
}

/// The first sweep was taken up before any motion was known. Now some is: what it is told by the second sweep.
void Loam::redo_first_sweep() {
  const std::int64_t middle_ns = odometry_.reference_ns();
  FeatureCloud features;
  for (int round = 0; round < kFirstSweepRounds; ++round) {
    features = features_of(first_->scan, corrected_track(), middle_ns);
    odometry_.revise(features);
    motion_ = odometry_.refine(followed_ns_, {predicted_motion(followed_ns_), motion_covariance(followed_ns_)},
                               motion_.pose, effort());
  }
  // The pose at the first sweep's end was given out long ago, and stays.
  if (steady_) {
    const Pose shift = track_.at(last_end_ns_) * corrected(track_.at(last_end_ns_), last_end_ns_).inverse();
    steady_->move(shift * state().world_from_body);
    track_.premultiply(shift);
    // What the first sweep moved by is therefore missing.
    const double share =
        seconds_between(first_->scan.stamp_ns, last_end_ns_) / seconds_between(middle_ns, followed_ns_);
    const Vector6d missing = share * Pose().local(motion_.pose);
    covariance_.displace_map(missing * missing.transpose());
  }
  matcher_.insert(features, world_from_reference(), path_m_);
  last_position_ = world_from_reference().translation;
  first_.reset();
}

void Loam::match(const FeatureCloud& features, std::int64_t stamp_ns) {
  if (!mapping_) return;
  const Pose predicted = track_.at(stamp_ns);
  matched_ = matcher_.match(features, {predicted, match_prior()});
  take_pose(matched_, predicted);
  health_.push_back(health_of(stamp_ns, Module::kLidar, matched_, predicted, 0.0));
}

/// The whole sweep was matched as if its motion were steady. Nothing else told how it was: an IMU would have.
PoseTrack Loam::bent(const Sweep& sweep, const FeatureCloud& features, const PoseTrack& steady) {
  const Pose matched = track_.at(sweep.end_ns);
  const PosePrior end{matched, kBentDoubt * kBentDoubt * match_prior()};
  PoseTrack track = bends_.bent(steady, features, sweep.scan.stamp_ns, sweep.end_ns, end, matcher_);
  const Pose shift = track.at(sweep.end_ns) * matched.inverse();
  steady_->move(shift * state().world_from_body);
  track_.premultiply(shift);
  return track;
}

void Loam::lay_down(const FeatureCloud& features, std::int64_t stamp_ns) {
  const Pose world_from_body = track_.at(stamp_ns);
  const Eigen::Vector3d step_in_body =
      world_from_body.rotation.conjugate() * (world_from_body.translation - last_position_);
  path_m_ += step_in_body.norm();
  last_position_ = world_from_body.translation;
  matcher_.insert(features, world_from_body, path_m_);
  matcher_.learn_range_biases(step_in_body.norm());
  if (steady_ && mapping_) covariance_.match(matched_, matcher_.drift(), step_in_body);
}

/// From the last sweep's end on, over which steady motion foresees what odometry does not tell.
void Loam::carry_covariance(std::int64_t end_ns, const Matrix6d& odometry_information) {
  if (!steady_) return;
  const double step_s = seconds_between(last_end_ns_, end_ns);
  const Matrix6d foreseen = steady_->motion_covariance(step_s).ldlt().solve(Matrix6d::Identity());
  covariance_.carry(track_.at(last_end_ns_).inverse() * corrected(track_.at(end_ns), end_ns),
                    (odometry_information + foreseen).ldlt().solve(Matrix6d::Identity()), step_s);
  covariance_.displace_map(
      read_turn_covariance(seconds_between(start_ns_, last_end_ns_), seconds_between(start_ns_, end_ns)));
}

/// Odometry's motion of a whole sweep. With an IMU the map alone feeds back: over a sweep the IMU knows its motion
/// better than the difference of two sweeps does.
void Loam::take_motion(std::int64_t now_ns) {
  if (!steady_) return;
  const Pose world_from_body = corrected(track_.at(now_ns), now_ns);
  const Pose moved = world_from_body * track_.at(now_ns).inverse();
  const std::int64_t state_ns = state().stamp_ns;
  steady_->follow(world_from_body, motion_.pose, seconds_between(odometry_.reference_ns(), now_ns));
  // A sweep arrives after its last return: what was predicted since then is predicted anew.
  PoseTrack redone;
  for (const PoseTrack::Stamped& at : track_.poses()) {
    const Pose before = moved * at.pose;
    const double since_s = seconds_between(now_ns, at.stamp_ns);
    redone.push(at.stamp_ns, at.stamp_ns <= now_ns ? before : steady_->onwards(world_from_body, since_s, before));
  }
  track_ = std::move(redone);
  steady_->move(track_.at(state_ns));
}

void Loam::take_pose(const SolveResult& solved, const Pose& predicted) {
  const Pose before = state().world_from_body;
  if (filter_) filter_->update_pose(solved, predicted, kSweepInflation);
  if (steady_) steady_->move(solved.pose * predicted.inverse() * before);
  track_.premultiply(state().world_from_body * before.inverse());
}

/// @param last_sweep  in B at its end
void Loam::begin_sweep(FeatureCloud last_sweep, std::int64_t middle_ns, std::int64_t end_ns,
                       const Pose& middle_from_end) {
  move(last_sweep, middle_from_end, 0.0F);
  odometry_.begin(last_sweep, middle_ns);
  last_end_ns_ = end_ns;
  reference_from_last_end_ = middle_from_end;
  if (filter_) filter_->set_keyframe(track_.at(end_ns));
  motion_ = {};
  followed_ns_ = middle_ns;
}

/// In B at reference_ns.
FeatureCloud Loam::features_of(const LidarScan& scan, const PoseTrack& world_from_body,
                               std::int64_t reference_ns) const {
  return extract_features(scan, deskew(scan, world_from_body, calibration_.body_from_lidar, reference_ns),
                          calibration_);
}

Pose Loam::world_from_reference() const { return track_.at(last_end_ns_) * reference_from_last_end_.inverse(); }

/// While no motion is known, cars that move along may outvote what stands still.
int Loam::effort() const { return first_ ? kFirstEffort : 1; }

/// reference_from_body.
Pose Loam::predicted_motion(std::int64_t now_ns) const { return world_from_reference().inverse() * track_.at(now_ns); }

Matrix6d Loam::motion_covariance(std::int64_t now_ns) const {
  return filter_ ? filter_->keyframe_motion_covariance()
                 : steady_->motion_covariance(seconds_between(odometry_.reference_ns(), now_ns));
}

Matrix6d Loam::match_prior() const {
  if (filter_) return filter_->pose_covariance();
  Matrix6d covariance = Matrix6d::Zero();
  const double turn_sigma = imu_ == ImuUse::kNone ? kOdometrySigma_rad : kReadAttitudeSigma_rad;
  covariance.diagonal().head<3>().setConstant(turn_sigma * turn_sigma);
  covariance.diagonal().tail<3>().setConstant(kOdometrySigma_m * kOdometrySigma_m);
  return covariance;
}

Matrix6d Loam::pose_covariance(std::int64_t stamp_ns) const {
  if (filter_) return filter_->pose_covariance();
  return covariance_.of_world() + steady_->bend_covariance() +
         steady_->motion_covariance(std::max(0.0, seconds_between(newest_ns_, stamp_ns)));
}

Matrix6d Loam::increment_covariance(double interval_s) const {
  if (!started()) return initializer_.increment_covariance();
  if (filter_) return increments_.covariance(interval_s);
  // Both ends of a second's increment are foreseen, on average, over half the time from one part of a sweep to the
  // next.
  return interval_s * (covariance_.per_s() + read_turn_covariance(0.0, 1.0) +
                       2.0 * (steady_->motion_covariance(0.5 * part_s_) + steady_->bend_covariance()));
}

/// Of attitude that is read, from one time since the start to another: the bias left in it turns it on and on.
Matrix6d Loam::read_turn_covariance(double from_s, double to_s) const {
  Matrix6d covariance = Matrix6d::Zero();
  if (imu_ != ImuUse::kOrientation) return covariance;
  const double growth = to_s * to_s - from_s * from_s;
  covariance.diagonal().head<3>().setConstant(growth * calibration_.imu.gyro_turn_on_sigma *
                                              calibration_.imu.gyro_turn_on_sigma);
  return covariance;
}

/// What odometry found wrong with the predicted motion, growing linearly from the reference time on.
Pose Loam::correction(std::int64_t stamp_ns) const {
  const std::int64_t reference_ns = odometry_.reference_ns();
  if (followed_ns_ <= reference_ns) return {};
  const double share = seconds_between(reference_ns, stamp_ns) / seconds_between(reference_ns, followed_ns_);
  return linear_share(motion_.pose, predicted_motion(followed_ns_), share);
}

/// A predicted world_from_body, corrected.
Pose Loam::corrected(const Pose& world_from_body, std::int64_t stamp_ns) const {
  const Pose origin = world_from_reference();
  return origin * correction(stamp_ns) * origin.inverse() * world_from_body;
}

PoseTrack Loam::corrected_track() const {
  PoseTrack result;
  for (const PoseTrack::Stamped& at : track_.poses()) result.push(at.stamp_ns, corrected(at.pose, at.stamp_ns));
  return result;
}

Odometry Loam::output(std::int64_t stamp_ns) {
  Odometry odometry;
  odometry.stamp_ns = stamp_ns;
  if (!started()) {
    odometry.world_from_body = initializer_.attitude();
    return odometry;
  }
  odometry.world_from_body = corrected(state().world_from_body, stamp_ns);
  odometry.velocity_in_world = state().velocity_in_world;
  odometry.gyro_bias = state().gyro_bias;
  odometry.accel_bias = state().accel_bias;
  odometry.covariance = pose_covariance(stamp_ns);
  odometry.lost = lost_.lost(odometry);
  return odometry;
}

std::vector<Odometry> Loam::take() { return std::exchange(outputs_, {}); }

}  // namespace plumbline
