#include "estimator/lidar/sweep_refinement.h"

#include <algorithm>
#include <utility>

#include "estimator/lidar/deskew.h"

namespace plumbline {
namespace {

constexpr std::int64_t kTrackStep_ns = 10'000'000;

}  // namespace

SweepRefinement::SweepRefinement(const Calibration& calibration, WeakDirections weak)
    : calibration_(calibration), weak_(weak), odometry_(calibration, weak) {}

std::optional<SweepRefinement::Sweep> SweepRefinement::add(const LidarScan& part, const PoseTrack& odometry_from_body,
                                                           const Matrix6d& covariance) {
  const std::int64_t now_ns = newest_return_ns(part);
  const bool silent = odometry_.begun() && now_ns - odometry_.reference_ns() > SweepOdometry::kLongestSilence_ns;
  if (silent || (odometry_.begun() && !odometry_from_body.covers(odometry_.reference_ns()))) {
    odometry_ = SweepOdometry(calibration_, weak_);
  }
  if (growing_ && *growing_ != part.sweep) odometry_.discard();  // its end never came
  growing_ = part.sweep;
  const bool sees = !part.points.empty();  // otherwise it only ends its sweep
  if (sees && odometry_.begun() && now_ns > odometry_.reference_ns()) {
    follow(part, odometry_from_body, covariance, now_ns);
  }
  const std::optional<LidarScan> sweep = assembler_.add(part);
  if (!sweep) return std::nullopt;
  growing_.reset();
  // Of a sweep whose first parts came before the odometry began nothing can be told.
  if (!odometry_from_body.covers(sweep->stamp_ns)) return std::nullopt;
  return finish(*sweep, odometry_from_body);
}

void SweepRefinement::follow(const LidarScan& part, const PoseTrack& odometry_from_body, const Matrix6d& covariance,
                             std::int64_t now_ns) {
  FeatureCloud features = features_of(part, odometry_from_body, now_ns);
  const Pose prediction = predicted(odometry_from_body, now_ns);
  move(features, prediction, static_cast<float>(seconds_between(odometry_.reference_ns(), part.stamp_ns)));
  odometry_.add(features);
  motion_ = odometry_.solve(now_ns, {prediction, covariance});
  followed_ns_ = now_ns;
}

SweepRefinement::Sweep SweepRefinement::finish(const LidarScan& scan, const PoseTrack& odometry_from_body) {
  Sweep sweep;
  sweep.end_ns = newest_return_ns(scan);
  const std::int64_t middle_ns = scan.stamp_ns + (sweep.end_ns - scan.stamp_ns) / 2;
  PoseTrack track = odometry_from_body;
  if (odometry_.begun() && followed_ns_ == sweep.end_ns) {
    sweep.solved = motion_;
    sweep.last_end_from_end = reference_from_last_end_.inverse() * motion_.pose;
    sweep.predicted_last_end_from_end =
        odometry_from_body.at(last_end_ns_).inverse() * odometry_from_body.at(sweep.end_ns);
    track = refined_over(scan, odometry_from_body);
  } else if (odometry_.begun()) {
    sweep.last_end_from_end = sweep.predicted_last_end_from_end =
        odometry_from_body.at(last_end_ns_).inverse() * odometry_from_body.at(sweep.end_ns);
  }
  sweep.features = features_of(scan, track, sweep.end_ns);
  const Pose middle_from_end = track.at(middle_ns).inverse() * track.at(sweep.end_ns);
  FeatureCloud in_middle = sweep.features;
  move(in_middle, middle_from_end, 0.0F);
  odometry_.begin(in_middle, middle_ns);
  last_end_ns_ = sweep.end_ns;
  reference_from_last_end_ = middle_from_end;
  motion_ = {};
  followed_ns_ = middle_ns;
  return sweep;
}

FeatureCloud SweepRefinement::features_of(const LidarScan& scan, const PoseTrack& odometry_from_body,
                                          std::int64_t at_ns) const {
  return extract_features(scan, deskew(scan, odometry_from_body, calibration_.body_from_lidar, at_ns), calibration_);
}

/// reference_from_body.
Pose SweepRefinement::predicted(const PoseTrack& odometry_from_body, std::int64_t stamp_ns) const {
  return odometry_from_body.at(odometry_.reference_ns()).inverse() * odometry_from_body.at(stamp_ns);
}

/// The same with what the solve found wrong with it, growing linearly from the reference time on.
Pose SweepRefinement::refined(const PoseTrack& odometry_from_body, std::int64_t stamp_ns) const {
  const double share =
      seconds_between(odometry_.reference_ns(), stamp_ns) / seconds_between(odometry_.reference_ns(), followed_ns_);
  return linear_share(motion_.pose, predicted(odometry_from_body, followed_ns_), share) *
         predicted(odometry_from_body, stamp_ns);
}

PoseTrack SweepRefinement::refined_over(const LidarScan& sweep, const PoseTrack& odometry_from_body) const {
  PoseTrack track;
  for (std::int64_t t = sweep.stamp_ns; t < sweep.end_ns; t += kTrackStep_ns) {
    track.push(t, refined(odometry_from_body, t));
  }
  track.push(sweep.end_ns, refined(odometry_from_body, sweep.end_ns));
  return track;
}

}  // namespace plumbline
