#include "estimator/vision/visual_odometry.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/geometry/interpolation.h"
#include "estimator/vision/depth_map.h"
#include "estimator/vision/feature_source.h"
#include "estimator/vision/lens_pixels.h"
#include "estimator/vision/motion_constraints.h"
#include "estimator/vision/stereo_depth.h"
#include "estimator/vision/triangulation.h"

namespace plumbline {
namespace {

/// An epipolar line exists only where the feature moved by more than its own noise.
constexpr double kLeastParallaxInSigma = 5.0;
/// What is unknown about a depthless feature's inverse depth while it has not moved: anything beyond some 3 m.
constexpr InverseDepth kFarAway{0.0, 0.3};
constexpr int kOutlierFramesToDrop = 3;
/// Patches are compared with their anchor as they were, so a new anchor is due before scale or roll deform them much.
constexpr double kAnchorMaxScaleChange = 0.08;
constexpr double kAnchorMaxRoll = 0.1;  // [rad]

struct Feature {
  std::int64_t id = 0;
  FeatureSighting sighting;                         ///< in pixels of the ideal pinhole
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< now, in the image as it came; so are the next two
  Eigen::Vector2f keyframe_pixel = Eigen::Vector2f::Zero();
  Eigen::Vector2f anchor_pixel = Eigen::Vector2f::Zero();
  double anchor_scale = 1.0;  ///< z^c / z^l when the anchor was taken
  InverseDepth triangulated;  ///< in the key-frame, from its whole track
  DepthSource depth_source = DepthSource::kNone;
  bool epipolar = false;                                    ///< which row kind this image gives
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();  ///< of its reprojection rows, else unused
  bool inlier = true;
  int outlier_frames = 0;  ///< in a row
};

SolveResult unsolved(const Pose& guess) {
  SolveResult result;
  result.pose = guess;
  return result;
}

TrackedFeature::Depth shown(DepthSource source) {
  switch (source) {
    case DepthSource::kNone:
      return TrackedFeature::Depth::kNone;
    case DepthSource::kTriangulated:
      return TrackedFeature::Depth::kTriangulated;
    default:
      return TrackedFeature::Depth::kMeasured;
  }
}

double scale_of(const CameraMotion& motion, const Feature& feature) {
  return (motion.camera_from_keyframe_rotation * feature.sighting.keyframe_ray +
          feature.sighting.depth.mean * motion.camera_from_keyframe_translation)
      .z();
}

double roll_of(const CameraMotion& motion) {
  return std::atan2(motion.camera_from_keyframe_rotation(1, 0), motion.camera_from_keyframe_rotation(0, 0));
}

}  // namespace

struct VisualOdometry::Impl {
  Impl(const Calibration& calibration, const VisionConfig& settings, bool with_remapping)
      : camera(calibration.camera),
        body_from_camera(calibration.body_from_camera),
        further_cameras(calibration.further_cameras),
        config(settings),
        remapping(with_remapping),
        source(calibration.camera, calibration.camera_noise),
        depth_map(calibration.camera, depth_config(calibration, settings)) {}

  static DepthMapConfig depth_config(const Calibration& calibration, const VisionConfig& settings) {
    DepthMapConfig depth;
    depth.max_age_s = settings.depth_max_age_s;
    depth.lidar.constant_m = calibration.lidar_range_sigma_m;
    return depth;
  }

  template <typename Frame>
  SolveResult process(const Frame& frame, const PosePrior& prior);
  void track(const Pose& predicted_keyframe_from_body);
  std::vector<FeatureSource::Sought> predict(const Pose& predicted_keyframe_from_body) const;
  void choose_rows(const PosePrior& prior);
  SolveResult solve_motion(const PosePrior& prior);
  void judge(const SolveResult& result);
  void renew_anchor();

  double overlap() const;
  bool worn_out() const;
  void carry_tracks_into_new_keyframe(const Pose& world_from_body);
  void refill();
  void give_depth(const Pose& world_from_body);
  template <typename Frame, typename Measure>
  void give_stereo_depth(const Frame& right, const Measure& measure);

  CameraIntrinsics camera;
  Pose body_from_camera;
  std::vector<FurtherCamera> further_cameras;
  VisionConfig config;
  bool remapping = true;

  FeatureSource source;
  DepthMap depth_map;
  std::optional<StereoDepth> stereo;  ///< made when the first frame of a second grey camera comes
  std::vector<Feature> features;
  bool has_image = false;
  std::int64_t newest_ns = 0;

  std::optional<Pose> world_from_keyframe;  ///< the body's pose; empty before the first key-frame
  std::int64_t keyframe_ns = 0;
  std::size_t keyframe_features = 0;
  Pose keyframe_from_newest;  ///< the body's motion, as last solved
  bool solved = false;
  double anchor_roll = 0.0;
};

VisualOdometry::VisualOdometry(const Calibration& calibration, const VisionConfig& config, bool remapping)
    : impl_(std::make_unique<Impl>(calibration, config, remapping)) {}
VisualOdometry::VisualOdometry(VisualOdometry&&) noexcept = default;
VisualOdometry& VisualOdometry::operator=(VisualOdometry&&) noexcept = default;
VisualOdometry::~VisualOdometry() = default;

void VisualOdometry::add_depth_points(std::int64_t stamp_ns, DepthSource source,
                                      const std::vector<Eigen::Vector3f>& points_in_world) {
  std::optional<Pose> world_from_camera;
  if (impl_->world_from_keyframe) {
    world_from_camera = *impl_->world_from_keyframe * impl_->keyframe_from_newest * impl_->body_from_camera;
  }
  impl_->depth_map.add(stamp_ns, source, points_in_world, world_from_camera);
}

SolveResult VisualOdometry::process(const CameraFrame& frame, const PosePrior& keyframe_from_body) {
  return impl_->process(frame, keyframe_from_body);
}

SolveResult VisualOdometry::process(const PointFrame& frame, const PosePrior& keyframe_from_body) {
  return impl_->process(frame, keyframe_from_body);
}

template <typename Frame>
SolveResult VisualOdometry::Impl::process(const Frame& frame, const PosePrior& prior) {
  solved = false;
  has_image = source.take(frame);
  if (!has_image) return unsolved(prior.mean);
  newest_ns = frame.stamp_ns;
  if (!world_from_keyframe) return unsolved(prior.mean);
  track(prior.mean);
  choose_rows(prior);
  const SolveResult result = solve_motion(prior);
  judge(result);
  renew_anchor();
  return result;
}

void VisualOdometry::add_stereo(const CameraFrame& right) {
  impl_->give_stereo_depth(right, [&](StereoDepth& stereo, const auto& features) {
    return stereo.measure(impl_->source.image(), right, features);
  });
}

void VisualOdometry::add_stereo(const PointFrame& right) {
  impl_->give_stereo_depth(
      right, [&](const StereoDepth& stereo, const auto& features) { return stereo.measure(right, features); });
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

void VisualOdometry::start_keyframe(const Pose& world_from_body) {
  Impl& m = *impl_;
  if (!m.has_image) return;
  m.carry_tracks_into_new_keyframe(world_from_body);
  m.refill();
  m.give_depth(world_from_body);
  m.source.anchor_here();
  m.world_from_keyframe = world_from_body;
  m.keyframe_ns = m.newest_ns;
  m.keyframe_features = m.features.size();
  m.keyframe_from_newest = Pose{};
  m.anchor_roll = 0.0;
}

std::vector<TrackedFeature> VisualOdometry::features() const {
  std::vector<TrackedFeature> tracked;
  tracked.reserve(impl_->features.size());
  for (const Feature& f : impl_->features) {
    tracked.push_back({f.pixel, f.keyframe_pixel, shown(f.depth_source), f.inlier});
  }
  return tracked;
}

/// Where the features should be: by depth and motion where the depth is known, else where the rotation since the last
/// image moves them.
std::vector<FeatureSource::Sought> VisualOdometry::Impl::predict(const Pose& predicted_keyframe_from_body) const {
  const CameraMotion from_keyframe = camera_motion(predicted_keyframe_from_body, body_from_camera);
  const CameraMotion from_last =
      camera_motion(keyframe_from_newest.inverse() * predicted_keyframe_from_body, body_from_camera);
  std::vector<FeatureSource::Sought> sought;
  sought.reserve(features.size());
  for (const Feature& f : features) {
    Eigen::Vector3d point = from_last.camera_from_keyframe_rotation * ray_through(camera, f.sighting.pixel);
    if (f.sighting.depth.known()) {
      point = from_keyframe.camera_from_keyframe_rotation * f.sighting.keyframe_ray +
              f.sighting.depth.mean * from_keyframe.camera_from_keyframe_translation;
    }
    const bool in_front = point.z() > 0.05;
    sought.push_back({f.id, f.anchor_pixel, in_front ? image_pixel(camera, project(camera, point)) : f.pixel});
  }
  return sought;
}

/// Moves the features to where the newest image shows them and forgets those that it does not show.
void VisualOdometry::Impl::track(const Pose& predicted_keyframe_from_body) {
  const FeatureTracker::Tracks tracks = source.locate(predict(predicted_keyframe_from_body));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks.pixels.size(); ++i) {
    if (tracks.found[i] == 0) continue;
    features[kept] = features[i];
    features[kept].pixel = tracks.pixels[i];
    features[kept++].sighting.pixel = pinhole_pixel(camera, tracks.pixels[i]);
  }
  features.resize(kept);
}

/// A depthless feature gives an epipolar row once its parallax exceeds what its noise and the prior's rotation could
/// feign; before that it is a direction, as of a point far away, and says nothing about translation. The noise of the
/// other rows depends on the motion as well. Both are decided once, at the prior, for all iterations: deciding anew at
/// every iterate tripled the iterations.
void VisualOdometry::Impl::choose_rows(const PosePrior& prior) {
  const CameraMotion motion = camera_motion(prior.mean, body_from_camera);
  const double rotation_px = camera.fx * std::sqrt(prior.covariance.topLeftCorner<3, 3>().trace());
  for (Feature& f : features) {
    const double least = kLeastParallaxInSigma * std::hypot(f.sighting.pixel_sigma, rotation_px);
    f.epipolar = f.depth_source == DepthSource::kNone && parallax_px(motion, camera, f.sighting) > least;
    if (!f.epipolar) f.whitening = reprojection_whitening(motion, camera, f.sighting);
  }
}

SolveResult VisualOdometry::Impl::solve_motion(const PosePrior& prior) {
  SolverOptions options;
  options.degeneracy_threshold = config.degeneracy_threshold;
  options.remapping = remapping;
  options.min_features = config.min_features;
  options.min_inlier_share = config.min_inlier_share;
  const auto linearize = [this](const Pose& pose, ResidualRows& rows) {
    const CameraMotion motion = camera_motion(pose, body_from_camera);
    for (const Feature& f : features) {
      if (f.epipolar) {
        const PixelRow row = epipolar_row(motion, camera, f.sighting);
        rows.add(row.residual, row.jacobian);
      } else {
        const PixelRows pair = reprojection_rows(motion, camera, f.sighting, f.whitening);
        rows.add(pair.residual[0], pair.jacobian.row(0), pair.residual[1], pair.jacobian.row(1));
      }
    }
  };
  return solve(prior.mean, prior, linearize, options);
}

/// Notes inliers and drops features that stay outliers: things that move, wrong depths, tracks gone astray.
void VisualOdometry::Impl::judge(const SolveResult& result) {
  keyframe_from_newest = result.pose;
  solved = result.spectrum.well_conditioned > 0;
  if (!solved) return;
  for (std::size_t i = 0; i < features.size(); ++i) {
    Feature& f = features[i];
    f.inlier = result.weights[i] > 0.0;
    f.outlier_frames = f.inlier ? 0 : f.outlier_frames + 1;
  }
  std::erase_if(features, [](const Feature& f) { return f.outlier_frames >= kOutlierFramesToDrop; });
}

void VisualOdometry::Impl::renew_anchor() {
  if (!solved || features.empty()) return;
  const CameraMotion motion = camera_motion(keyframe_from_newest, body_from_camera);
  double change = 0.0;
  for (const Feature& f : features) change += std::abs(scale_of(motion, f) / f.anchor_scale - 1.0);
  change /= static_cast<double>(features.size());
  const double roll = roll_of(motion);
  if (change < kAnchorMaxScaleChange && std::abs(roll - anchor_roll) < kAnchorMaxRoll) return;
  source.anchor_here();
  anchor_roll = roll;
  for (Feature& f : features) {
    f.anchor_pixel = f.pixel;
    f.anchor_scale = scale_of(motion, f);
  }
}

/// The share of the key-frame's view that the newest image still shows, from the features' mean shift.
double VisualOdometry::Impl::overlap() const {
  if (features.empty()) return 0.0;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  for (const Feature& f : features) shift += (f.pixel - f.keyframe_pixel).cast<double>();
  shift /= static_cast<double>(features.size());
  return (1.0 - std::abs(shift.x()) / camera.width) * (1.0 - std::abs(shift.y()) / camera.height);
}

bool VisualOdometry::Impl::worn_out() const {
  const double tracked_share = static_cast<double>(features.size()) / static_cast<double>(keyframe_features);
  return tracked_share < config.keyframe_tracked_share || overlap() < config.keyframe_overlap;
}

/// Expresses the surviving tracks, and what the motion has taught about their depth, in the newest image.
void VisualOdometry::Impl::carry_tracks_into_new_keyframe(const Pose& world_from_body) {
  if (!world_from_keyframe) return;
  const CameraMotion motion = camera_motion(world_from_keyframe->inverse() * world_from_body, body_from_camera);
  std::erase_if(features, [](const Feature& f) { return !f.inlier; });
  for (Feature& f : features) {
    if (const auto seen = triangulate(motion, camera, f.sighting); solved && seen) {
      f.triangulated = fuse(f.triangulated, *seen);
    }
    f.triangulated = carried_along(f.triangulated, motion, f.sighting.keyframe_ray);
    f.sighting.keyframe_ray = ray_through(camera, f.sighting.pixel);
    f.keyframe_pixel = f.anchor_pixel = f.pixel;
    f.anchor_scale = 1.0;
  }
}

void VisualOdometry::Impl::refill() {
  std::vector<FeatureSource::Seen> present;
  present.reserve(features.size());
  for (const Feature& f : features) present.push_back({f.id, f.keyframe_pixel});
  CornerOptions options;
  options.grid_rows = config.grid_rows;
  options.grid_cols = config.grid_cols;
  options.features_per_cell = config.features_per_cell;
  for (const FeatureSource::Fresh& fresh : source.find_new(present, options)) {
    Feature f;
    f.id = fresh.id;
    f.pixel = f.keyframe_pixel = f.anchor_pixel = fresh.pixel;
    f.sighting.pixel = pinhole_pixel(camera, fresh.pixel);
    f.sighting.keyframe_ray = ray_through(camera, f.sighting.pixel);
    f.sighting.pixel_sigma = std::hypot(config.pixel_sigma_px, fresh.noise_sigma_px);
    features.push_back(f);
  }
}

/// The depth map's depth first, then the triangulated, then none (thesis 5.2).
void VisualOdometry::Impl::give_depth(const Pose& world_from_body) {
  depth_map.look_from(world_from_body * body_from_camera, newest_ns);
  for (Feature& f : features) {
    f.epipolar = false;
    f.depth_source = DepthSource::kNone;
    f.sighting.depth = kFarAway;
    if (const auto depth = depth_map.depth_along(f.sighting.keyframe_ray)) {
      f.depth_source = depth->source;
      f.sighting.depth = f.triangulated = depth->depth;
    } else if (converged(f.triangulated)) {
      f.depth_source = DepthSource::kTriangulated;
      f.sighting.depth = f.triangulated;
    }
  }
}

/// Where the depth map has nothing: the depth of a pair grows unsure with its square, the lidar's does not.
template <typename Frame, typename Measure>
void VisualOdometry::Impl::give_stereo_depth(const Frame& right, const Measure& measure) {
  // A pair is two frames of one moment, and only a key-frame asks for depth.
  if (!world_from_keyframe || right.stamp_ns != keyframe_ns || newest_ns != keyframe_ns) return;
  if (!stereo) {
    const auto camera_of_frame = std::find_if(further_cameras.begin(), further_cameras.end(),
                                              [&](const FurtherCamera& c) { return c.camera_id == right.camera_id; });
    if (camera_of_frame == further_cameras.end()) return;
    stereo.emplace(camera, body_from_camera, *camera_of_frame);
  }
  std::vector<StereoDepth::Feature> lacking;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Feature& f = features[i];
    if (f.depth_source != DepthSource::kNone && f.depth_source != DepthSource::kTriangulated) continue;
    lacking.push_back({f.id, f.pixel, f.sighting.keyframe_ray, f.sighting.pixel_sigma, f.triangulated});
    indices.push_back(i);
  }
  const std::vector<std::optional<InverseDepth>> depths = measure(*stereo, lacking);
  for (std::size_t k = 0; k < depths.size(); ++k) {
    if (!depths[k]) continue;
    Feature& f = features[indices[k]];
    f.triangulated = fuse(f.triangulated, *depths[k]);
    f.sighting.depth = f.triangulated;
    f.depth_source = DepthSource::kStereo;
  }
}

}  // namespace plumbline
