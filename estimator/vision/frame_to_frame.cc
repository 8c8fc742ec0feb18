#include "estimator/vision/frame_to_frame.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/so3.h"
#include "estimator/vision/feature_set.h"
#include "estimator/vision/triangulation.h"

namespace plumbline {
namespace {

/// Below this motion [m] from image to image, two pixels or so at 10 m, an epipolar line's direction is noise.
constexpr double kLeastEpipolarMotion_m = 0.01;
/// A track is triangulated anew when its baseline has grown by this share: measurements between would repeat the last.
constexpr double kBaselineGrowth = 1.3;
/// Of a depthless feature's inverse depth: so little that nothing follows along its epipolar line. Taken for far away,
/// points on the ground turn the pitch by as much as they lie nearer, in every image.
constexpr InverseDepth kUnknownDepth{0.0, 5.0};

FeatureSetConfig feature_config(const FrameToFrameConfig& config) {
  FeatureSetConfig features;
  features.corners.grid_rows = config.grid_rows;
  features.corners.grid_cols = config.grid_cols;
  features.corners.features_per_cell = config.features_per_cell;
  features.point_sigma_px = config.point_sigma_px;
  features.depth_max_age_s = config.depth_max_age_s;
  return features;
}

/// Where a feature was first seen, and from which baseline its depth was last triangulated (thesis 3.4.3).
struct FirstSight {
  Pose odometry_from_body;
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
  double used_baseline_m = 0.0;
};

bool measured(const Feature& f) {
  return f.depth_source != DepthSource::kNone && f.depth_source != DepthSource::kTriangulated;
}

}  // namespace

struct FrameToFrame::Impl {
  Impl(const Calibration& calibration, const FrameToFrameConfig& settings, WeakDirections weak_directions)
      : config(settings), weak(weak_directions), set(calibration, feature_config(settings)) {}

  template <typename Frame>
  Step process(const Frame& frame);
  template <typename Frame>
  void add_stereo(const Frame& right);
  Pose motion_over(double seconds) const;
  Pose predicted(std::int64_t stamp_ns) const;
  void choose_rows(const Pose& predicted);
  SolveResult solve_motion(const Pose& predicted) const;
  void accept(const SolveResult& solved);
  void skip(const Pose& predicted);
  void make_newest_the_reference(const Pose& motion);
  void leave_unmeasured_depths();
  void triangulate_tracks();
  void refill();

  FrameToFrameConfig config;
  WeakDirections weak = WeakDirections::kGuessed;
  FeatureSet set;  ///< its reference is the last image that was not skipped
  std::map<std::int64_t, FirstSight> first_sights;
  std::int64_t refill_ns = 0;
  std::size_t refilled_features = 0;
  bool count_due = false;  ///< features were refilled, and some may have to go for want of depth

  bool started = false;
  bool has_reference = false;  ///< false: gone on without an image so far
  std::int64_t reference_ns = 0;
  std::int64_t newest_ns = 0;
  Pose odometry_from_reference;
  Pose odometry_from_newest;
  Vector6d velocity = Vector6d::Zero();  ///< [rad/s; m/s] in B
};

FrameToFrame::FrameToFrame(const Calibration& calibration, const FrameToFrameConfig& config, WeakDirections weak)
    : impl_(std::make_unique<Impl>(calibration, config, weak)) {}
FrameToFrame::FrameToFrame(FrameToFrame&&) noexcept = default;
FrameToFrame& FrameToFrame::operator=(FrameToFrame&&) noexcept = default;
FrameToFrame::~FrameToFrame() = default;

FrameToFrame::Step FrameToFrame::process(const CameraFrame& frame) { return impl_->process(frame); }
FrameToFrame::Step FrameToFrame::process(const PointFrame& frame) { return impl_->process(frame); }

void FrameToFrame::add_stereo(const CameraFrame& right) { impl_->add_stereo(right); }
void FrameToFrame::add_stereo(const PointFrame& right) { impl_->add_stereo(right); }

void FrameToFrame::add_depth_points(std::int64_t stamp_ns, const std::vector<Eigen::Vector3f>& points_in_body,
                                    const Pose& odometry_from_body) {
  impl_->set.add_depth_points(stamp_ns, DepthSource::kLidar, points_in_body, odometry_from_body);
}

void FrameToFrame::add_depth_image(const DepthFrame& frame) {
  impl_->set.add_depth_image(frame, predicted(frame.stamp_ns));
}

void FrameToFrame::go_on(std::int64_t stamp_ns, const Vector6d& velocity) {
  if (!started() || stamp_ns > impl_->newest_ns) {
    impl_->odometry_from_newest = predicted(stamp_ns);
    impl_->newest_ns = stamp_ns;
    impl_->started = true;
  }
  impl_->velocity = velocity;
}

bool FrameToFrame::started() const { return impl_->started; }
std::int64_t FrameToFrame::newest_ns() const { return impl_->newest_ns; }
const Pose& FrameToFrame::odometry_from_body() const { return impl_->odometry_from_newest; }

Pose FrameToFrame::predicted(std::int64_t stamp_ns) const { return started() ? impl_->predicted(stamp_ns) : Pose{}; }

std::vector<FrameToFrame::Sighting> FrameToFrame::inliers() const {
  std::vector<Sighting> sightings;
  for (const Feature& f : impl_->set.features) {
    if (!f.inlier) continue;
    sightings.push_back({f.id, f.sighting.pixel, f.sighting.pixel_sigma, f.sighting.depth, f.depth_source});
  }
  return sightings;
}

std::vector<TrackedFeature> FrameToFrame::features() const { return impl_->set.shown(); }

template <typename Frame>
void FrameToFrame::Impl::add_stereo(const Frame& right) {
  const bool shows_reference = has_reference && right.stamp_ns == reference_ns && reference_ns == newest_ns;
  if (shows_reference) set.give_stereo_depth(right);
}

template <typename Frame>
FrameToFrame::Step FrameToFrame::Impl::process(const Frame& frame) {
  Step step;
  if (!set.take(frame)) return step;
  if (!has_reference) {
    has_reference = true;
    if (started) odometry_from_newest = predicted(frame.stamp_ns);
    started = true;
    odometry_from_reference = odometry_from_newest;
    reference_ns = newest_ns = frame.stamp_ns;
    refill();
    set.give_depth(odometry_from_reference, reference_ns);
    return step;
  }
  const Pose reference_from_last = odometry_from_reference.inverse() * odometry_from_newest;
  step.predicted = odometry_from_reference.inverse() * predicted(frame.stamp_ns);
  newest_ns = frame.stamp_ns;
  if (config.map_depth_only) std::erase_if(set.features, [](const Feature& f) { return !measured(f); });
  leave_unmeasured_depths();
  if (std::exchange(count_due, false)) refilled_features = set.features.size();
  set.track(step.predicted, reference_from_last);
  choose_rows(step.predicted);
  step.solved = solve_motion(step.predicted);
  step.skipped = step.solved.spectrum.well_conditioned == 0;
  if (step.skipped) {
    skip(step.predicted);
  } else {
    accept(step.solved);
  }
  return step;
}

Pose FrameToFrame::Impl::motion_over(double seconds) const {
  return {exp_so3(seconds * velocity.head<3>()), seconds * velocity.tail<3>()};
}

Pose FrameToFrame::Impl::predicted(std::int64_t stamp_ns) const {
  return odometry_from_newest * motion_over(seconds_between(newest_ns, stamp_ns));
}

/// Depthless features give epipolar rows (3.6) as soon as there is motion to speak of; at rest they are directions, as
/// of points far away. Kinds and noise are decided once, at the prediction, for all iterations.
void FrameToFrame::Impl::choose_rows(const Pose& predicted) {
  const CameraMotion motion = set.motion(predicted);
  const bool moving = motion.camera_from_keyframe_translation.norm() > kLeastEpipolarMotion_m;
  for (Feature& f : set.features) {
    f.epipolar = f.depth_source == DepthSource::kNone && moving;
    if (!f.epipolar) f.whitening = reprojection_whitening(motion, set.camera(), f.sighting);
  }
}

/// Algorithm 1. The prediction is the first guess and stands along the directions that the image does not determine.
SolveResult FrameToFrame::Impl::solve_motion(const Pose& predicted) const {
  SolverOptions options;
  options.degeneracy_threshold = config.degeneracy_threshold;
  options.weak = weak;
  options.min_features = config.min_features;
  options.min_inlier_share = config.min_inlier_share;
  return solve(
      predicted, std::nullopt, [this](const Pose& pose, ResidualRows& rows) { set.linearize(pose, rows); }, options);
}

void FrameToFrame::Impl::accept(const SolveResult& solved) {
  set.judge(solved.weights);
  set.drop_riders(solved.pose, newest_ns);
  set.renew_anchor(solved.pose);
  velocity << log_so3(solved.pose.rotation), solved.pose.translation;
  velocity /= seconds_between(reference_ns, newest_ns);
  make_newest_the_reference(solved.pose);
}

/// Algorithm 1 neglects a frame with few inliers: the next one is compared with the same image as this was. After a
/// while that image is left behind; a motion that nothing shows any more is believed less and less.
void FrameToFrame::Impl::skip(const Pose& predicted) {
  odometry_from_newest = odometry_from_reference * predicted;
  if (seconds_between(reference_ns, newest_ns) < config.restart_s) return;
  velocity *= 0.5;
  set.features.clear();
  make_newest_the_reference(predicted);
}

void FrameToFrame::Impl::make_newest_the_reference(const Pose& motion) {
  set.make_newest_the_reference(motion);
  reference_ns = newest_ns;
  odometry_from_reference = odometry_from_newest = odometry_from_reference * motion;
  triangulate_tracks();
  const bool worn =
      static_cast<double>(set.features.size()) < config.refill_share * static_cast<double>(refilled_features);
  const bool few = set.features.size() < static_cast<std::size_t>(config.min_features);
  if ((worn || few) && seconds_between(refill_ns, newest_ns) >= config.refill_pause_s) refill();
  set.give_depth(odometry_from_reference, reference_ns);
}

/// A depth triangulated with a wrong motion agrees with that wrong motion ever after. From image to image nothing else
/// says otherwise but measured depths, and these are outvoted: walking over a plain that 77 of 270 features had
/// measured depths of, the yaw went astray by 0.2 degrees a second. So triangulated depths wait until measured ones are
/// too few for a solution.
void FrameToFrame::Impl::leave_unmeasured_depths() {
  const bool enough = std::count_if(set.features.begin(), set.features.end(), measured) >= config.min_features;
  for (Feature& f : set.features) {
    if (f.depth_source == DepthSource::kTriangulated && enough) {
      f.depth_source = DepthSource::kNone;
      f.plane.setZero();
    }
    if (f.depth_source == DepthSource::kNone) f.sighting.depth = kUnknownDepth;
  }
}

/// Measures a track's depth over the distance between its first sight and now, whenever that distance has grown.
void FrameToFrame::Impl::triangulate_tracks() {
  std::map<std::int64_t, FirstSight> kept;
  for (Feature& f : set.features) {
    const auto known = first_sights.find(f.id);
    FirstSight first =
        known != first_sights.end() ? known->second : FirstSight{odometry_from_reference, f.sighting.keyframe_ray, 0.0};
    const CameraMotion motion = set.motion(first.odometry_from_body.inverse() * odometry_from_reference);
    const double baseline_m = motion.camera_from_keyframe_translation.norm();
    if (f.inlier && baseline_m > kBaselineGrowth * first.used_baseline_m) {
      FeatureSighting whole_track = f.sighting;
      whole_track.keyframe_ray = first.ray;
      if (const auto depth = triangulate(motion, set.camera(), whole_track)) {
        f.triangulated = fuse(f.triangulated, carried_along(*depth, motion, first.ray));
        first.used_baseline_m = baseline_m;
      }
    }
    kept.emplace(f.id, first);
  }
  first_sights = std::move(kept);
}

/// New features need an anchor, and there is one for all.
void FrameToFrame::Impl::refill() {
  set.refill();
  set.anchor_here(Pose{});
  refill_ns = newest_ns;
  refilled_features = set.features.size();
  count_due = true;
}

}  // namespace plumbline
