#include "estimator/vision/visual_odometry.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/geometry/interpolation.h"
#include "estimator/vision/feature_set.h"
#include "estimator/vision/triangulation.h"

namespace plumbline {
namespace {

/// An epipolar line exists only where the feature moved by more than its own noise.
constexpr double kLeastParallaxInSigma = 5.0;

SolveResult unsolved(const Pose& guess) {
  SolveResult result;
  result.pose = guess;
  return result;
}

FeatureSetConfig feature_config(const VisionConfig& config) {
  FeatureSetConfig features;
  features.corners.grid_rows = config.grid_rows;
  features.corners.grid_cols = config.grid_cols;
  features.corners.features_per_cell = config.features_per_cell;
  features.point_sigma_px = config.point_sigma_px;
  features.depth_max_age_s = config.depth_max_age_s;
  return features;
}

}  // namespace

struct VisualOdometry::Impl {
  Impl(const Calibration& calibration, const VisionConfig& settings, WeakDirections weak_directions)
      : config(settings), weak(weak_directions), set(calibration, feature_config(settings)) {}

  template <typename Frame>
  SolveResult process(const Frame& frame, const PosePrior& prior);
  template <typename Frame>
  bool follow(const Frame& frame, const PosePrior& prior);
  void settle(const Pose& keyframe_from_body, const std::vector<double>& weights);
  template <typename Frame>
  void add_stereo(const Frame& right);
  void choose_rows(const PosePrior& prior);
  SolveResult solve_motion(const PosePrior& prior) const;

  bool worn_out() const;
  void carry_tracks_into_new_keyframe(const Pose& world_from_body, const Eigen::Quaterniond& turn_by_gyroscope);

  VisionConfig config;
  WeakDirections weak = WeakDirections::kGuessed;

  FeatureSet set;  ///< its reference is the key-frame
  bool has_image = false;
  std::int64_t newest_ns = 0;

  std::optional<Pose> world_from_keyframe;  ///< the body's pose; empty before the first key-frame
  std::int64_t keyframe_ns = 0;
  std::size_t keyframe_features = 0;
  Pose keyframe_from_newest;  ///< the body's motion, as last solved
  double turn_sigma = 0.0;    ///< of the prior's rotation across an axis [rad]
  bool solved = false;
};

VisualOdometry::VisualOdometry(const Calibration& calibration, const VisionConfig& config, WeakDirections weak)
    : impl_(std::make_unique<Impl>(calibration, config, weak)) {}
VisualOdometry::VisualOdometry(VisualOdometry&&) noexcept = default;
VisualOdometry& VisualOdometry::operator=(VisualOdometry&&) noexcept = default;
VisualOdometry::~VisualOdometry() = default;

void VisualOdometry::add_depth_points(std::int64_t stamp_ns, const std::vector<Eigen::Vector3f>& points_in_body,
                                      const Pose& world_from_body) {
  impl_->set.add_depth_points(stamp_ns, DepthSource::kLidar, points_in_body, world_from_body);
}

void VisualOdometry::add_depth_image(const DepthFrame& frame, const Pose& world_from_body) {
  impl_->set.add_depth_image(frame, world_from_body);
}

SolveResult VisualOdometry::process(const CameraFrame& frame, const PosePrior& keyframe_from_body) {
  return impl_->process(frame, keyframe_from_body);
}

SolveResult VisualOdometry::process(const PointFrame& frame, const PosePrior& keyframe_from_body) {
  return impl_->process(frame, keyframe_from_body);
}

template <typename Frame>
SolveResult VisualOdometry::Impl::process(const Frame& frame, const PosePrior& prior) {
  if (!follow(frame, prior)) return unsolved(prior.mean);
  const SolveResult result = solve_motion(prior);
  keyframe_from_newest = result.pose;
  if (result.spectrum.well_conditioned > 0) settle(result.pose, result.weights);
  return result;
}

bool VisualOdometry::follow(const CameraFrame& frame, const PosePrior& prior) { return impl_->follow(frame, prior); }
bool VisualOdometry::follow(const PointFrame& frame, const PosePrior& prior) { return impl_->follow(frame, prior); }

template <typename Frame>
bool VisualOdometry::Impl::follow(const Frame& frame, const PosePrior& prior) {
  solved = false;
  has_image = set.take(frame);
  if (!has_image) return false;
  newest_ns = frame.stamp_ns;
  if (!world_from_keyframe) return false;
  set.track(prior.mean, keyframe_from_newest);
  turn_sigma = std::sqrt(prior.covariance.topLeftCorner<3, 3>().trace() / 3.0);
  choose_rows(prior);
  keyframe_from_newest = prior.mean;
  return true;
}

void VisualOdometry::linearize(const Pose& keyframe_from_body, ResidualRows& rows) const {
  impl_->set.linearize(keyframe_from_body, rows);
}

void VisualOdometry::settle(const Pose& keyframe_from_body, const std::vector<double>& weights) {
  impl_->settle(keyframe_from_body, weights);
}

void VisualOdometry::Impl::settle(const Pose& keyframe_from_body, const std::vector<double>& weights) {
  solved = true;
  keyframe_from_newest = keyframe_from_body;
  set.judge(weights);
  set.renew_anchor(keyframe_from_newest);
}

void VisualOdometry::add_stereo(const CameraFrame& right) { impl_->add_stereo(right); }
void VisualOdometry::add_stereo(const PointFrame& right) { impl_->add_stereo(right); }

/// A pair is two frames of one moment, and only a key-frame asks for depth.
template <typename Frame>
void VisualOdometry::Impl::add_stereo(const Frame& right) {
  const bool shows_keyframe = world_from_keyframe && right.stamp_ns == keyframe_ns && newest_ns == keyframe_ns;
  if (shows_keyframe) set.give_stereo_depth(right);
}

bool VisualOdometry::wants_keyframe() const {
  const Impl& m = *impl_;
  if (!m.has_image) return false;
  if (!m.world_from_keyframe) return true;
  const double age_s = seconds_between(m.keyframe_ns, m.newest_ns);
  // A key-frame that found next to nothing (darkness, a blank wall) is not worth a search at every image.
  if (m.keyframe_features < static_cast<std::size_t>(m.config.min_features)) return age_s >= m.config.keyframe_retry_s;
  return age_s >= m.config.keyframe_max_age_s || m.worn_out();
}

void VisualOdometry::start_keyframe(const Pose& world_from_body, const Eigen::Quaterniond& turn_by_gyroscope) {
  Impl& m = *impl_;
  if (!m.has_image) return;
  if (m.world_from_keyframe) m.carry_tracks_into_new_keyframe(world_from_body, turn_by_gyroscope);
  m.set.refill();
  m.set.give_depth(world_from_body, m.newest_ns);
  m.set.anchor_here(Pose{});
  m.world_from_keyframe = world_from_body;
  m.keyframe_ns = m.newest_ns;
  m.keyframe_features = m.set.features.size();
  m.keyframe_from_newest = Pose{};
}

std::vector<TrackedFeature> VisualOdometry::features() const { return impl_->set.shown(); }

/// A depthless feature gives an epipolar row once its parallax exceeds what its noise and the prior's rotation could
/// feign; before that it is a direction, as of a point far away, and says nothing about translation. The noise of the
/// other rows depends on the motion as well. Both are decided once, at the prior, for all iterations: deciding anew at
/// every iterate tripled the iterations.
void VisualOdometry::Impl::choose_rows(const PosePrior& prior) {
  const CameraMotion motion = set.motion(prior.mean);
  const CameraIntrinsics& camera = set.camera();
  const double rotation_px = camera.fx * std::sqrt(prior.covariance.topLeftCorner<3, 3>().trace());
  for (Feature& f : set.features) {
    const double least = kLeastParallaxInSigma * std::hypot(f.sighting.pixel_sigma, rotation_px);
    f.epipolar = f.depth_source == DepthSource::kNone && parallax_px(motion, camera, f.sighting) > least;
    if (!f.epipolar) f.whitening = reprojection_whitening(motion, camera, f.sighting);
  }
}

SolveResult VisualOdometry::Impl::solve_motion(const PosePrior& prior) const {
  SolverOptions options;
  options.degeneracy_threshold = config.degeneracy_threshold;
  options.weak = weak;
  options.min_features = config.min_features;
  options.min_inlier_share = config.min_inlier_share;
  return solve(
      prior.mean, prior, [this](const Pose& pose, ResidualRows& rows) { set.linearize(pose, rows); }, options);
}

bool VisualOdometry::Impl::worn_out() const {
  const double tracked_share = static_cast<double>(set.features.size()) / static_cast<double>(keyframe_features);
  return tracked_share < config.keyframe_tracked_share || set.overlap() < config.keyframe_overlap;
}

/// Expresses the surviving tracks, and what the motion has taught about their depth, in the newest image.
void VisualOdometry::Impl::carry_tracks_into_new_keyframe(const Pose& world_from_body,
                                                          const Eigen::Quaterniond& turn_by_gyroscope) {
  const Pose keyframe_from_body = world_from_keyframe->inverse() * world_from_body;
  // The solved rotation came from these very features: depths made with it would vote for it ever after.
  const Pose by_gyroscope{turn_by_gyroscope, keyframe_from_body.translation};
  set.drop_riders(by_gyroscope, newest_ns);
  std::erase_if(set.features, [](const Feature& f) { return !f.inlier; });
  const CameraMotion motion = set.motion(by_gyroscope);
  for (Feature& f : set.features) {
    // A turn's error moves the pixel as a track's own does.
    FeatureSighting sighting = f.sighting;
    sighting.pixel_sigma = std::hypot(sighting.pixel_sigma, set.camera().fx * turn_sigma);
    if (const auto seen = triangulate(motion, set.camera(), sighting); solved && seen) {
      f.triangulated = fuse(f.triangulated, *seen);
    }
  }
  set.make_newest_the_reference(keyframe_from_body);
}

}  // namespace plumbline
