#include "estimator/vision/feature_set.h"

#include <algorithm>
#include <cmath>

#include "estimator/geometry/interpolation.h"
#include "estimator/vision/depth_image.h"
#include "estimator/vision/lens_pixels.h"
#include "estimator/vision/triangulation.h"

namespace plumbline {
namespace {

constexpr int kOutlierFramesToDrop = 3;
/// The tracker comes near a patch by shifting it, so a new anchor is due before scale, roll or slant deform it much.
constexpr double kAnchorMaxChange = 0.08;
constexpr double kMostAreaChange = 4.0;     // of a patch: beyond it the plane or the motion is wrong
constexpr double kPlaceSigma_px = 0.1;      // of a track: interpolation, the lens's calibration
constexpr double kDepthImagePause_s = 0.1;  // between depth images used: the map keeps seconds of them
constexpr double kLeastShareOfSigma = 0.5;
// Of a triangulated depth: what the motions it was measured with had wrong in common, which no averaging cuts. Against
// exact motion, four in five depths taken at 25 m/s lie within 0.91 to 1.12 of what they should be, for a claimed 3 %.
constexpr double kMotionShare = 0.08;
constexpr std::int64_t kRiddenMemory_ns = 20'000'000'000;

DepthMapConfig depth_config(const Calibration& calibration, const FeatureSetConfig& config) {
  DepthMapConfig depth;
  depth.max_age_s = config.depth_max_age_s;
  depth.lidar.constant_m = calibration.lidar_range_sigma_m;
  return depth;
}

TrackedFeature::Depth shown_depth(DepthSource source) {
  switch (source) {
    case DepthSource::kNone:
      return TrackedFeature::Depth::kNone;
    case DepthSource::kTriangulated:
      return TrackedFeature::Depth::kTriangulated;
    default:
      return TrackedFeature::Depth::kLidar;
  }
}

/// d pixel d reference pixel at a feature: its surface's homography, R + t plane^T. How a lens's distortion differs
/// between the two places is left out.
Eigen::Matrix2d shape_of(const CameraMotion& motion, const CameraIntrinsics& camera, const Feature& feature) {
  const Eigen::Matrix3d now_from_reference =
      motion.camera_from_keyframe_rotation + motion.camera_from_keyframe_translation * feature.plane.transpose();
  const Eigen::Vector3d h = now_from_reference * feature.sighting.keyframe_ray;
  const Eigen::Matrix2d shape = d_pixel_d_point(camera, h) * now_from_reference.leftCols<2>() *
                                Eigen::Vector2d(1.0 / camera.fx, 1.0 / camera.fy).asDiagonal();
  const double area = shape.determinant();
  const bool sensible = h.z() > kLeastDepthRatio && area > 1.0 / kMostAreaChange && area < kMostAreaChange;
  return sensible ? shape : Eigen::Matrix2d::Identity();
}

Eigen::Vector3d facing_plane(const InverseDepth& depth) { return depth.mean * Eigen::Vector3d::UnitZ(); }

/// plane . X = 1 with X = R^T (X' - t).
Eigen::Vector3d carried_along(const Eigen::Vector3d& plane, const CameraMotion& motion) {
  const Eigen::Vector3d turned = motion.camera_from_keyframe_rotation * plane;
  const double offset = 1.0 + turned.dot(motion.camera_from_keyframe_translation);
  return offset > kLeastDepthRatio ? Eigen::Vector3d(turned / offset) : Eigen::Vector3d::Zero();
}

}  // namespace

FeatureSet::FeatureSet(const Calibration& calibration, const FeatureSetConfig& config)
    : camera_(calibration.camera),
      body_from_camera_(calibration.body_from_camera),
      further_cameras_(calibration.further_cameras),
      config_(config),
      source_(calibration.camera, calibration.camera_noise),
      depth_map_(calibration.camera, depth_config(calibration, config)) {}

/// Where the features should be: by depth and motion where the depth is known, else where the rotation since the last
/// image moves them.
std::vector<FeatureSource::Sought> FeatureSet::predict(const Pose& predicted_reference_from_body,
                                                       const Pose& reference_from_last_body) const {
  const CameraMotion from_reference = motion(predicted_reference_from_body);
  const CameraMotion from_last = motion(reference_from_last_body.inverse() * predicted_reference_from_body);
  std::vector<FeatureSource::Sought> sought;
  sought.reserve(features.size());
  for (const Feature& f : features) {
    Eigen::Vector3d point = from_last.camera_from_keyframe_rotation * ray_through(camera_, f.sighting.pixel);
    if (f.sighting.depth.known()) {
      point = from_reference.camera_from_keyframe_rotation * f.sighting.keyframe_ray +
              f.sighting.depth.mean * from_reference.camera_from_keyframe_translation;
    }
    const bool in_front = point.z() > 0.05;
    const Eigen::Matrix2d now_from_anchor = shape_of(from_reference, camera_, f) * f.anchor_shape.inverse();
    sought.push_back({f.id,
                      {f.anchor_pixel, in_front ? image_pixel(camera_, project(camera_, point)) : f.pixel,
                       now_from_anchor.cast<float>()}});
  }
  return sought;
}

void FeatureSet::track(const Pose& predicted_reference_from_body, const Pose& reference_from_last_body) {
  const std::vector<FeatureTracker::Track> tracks =
      source_.locate(predict(predicted_reference_from_body, reference_from_last_body));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!tracks[i].found) continue;
    Feature& f = features[kept++] = features[i];
    f.pixel = tracks[i].pixel;
    f.track_sigma = static_cast<double>(tracks[i].sigma_px);
    f.sighting.pixel = pinhole_pixel(camera_, f.pixel);
    f.sighting.pixel_sigma = std::hypot(sigma_of_any_place(), f.track_sigma, f.anchor_sigma);
  }
  features.resize(kept);
}

/// Of points given, all there is; of tracks, what neither noise nor a patch's look tells: calibration, interpolation.
double FeatureSet::sigma_of_any_place() const { return shows_images() ? kPlaceSigma_px : config_.point_sigma_px; }

bool FeatureSet::shows_images() const { return source_.image().data != nullptr; }

void FeatureSet::linearize(const Pose& reference_from_body, ResidualRows& rows) const {
  const CameraMotion camera_now = motion(reference_from_body);
  for (const Feature& f : features) {
    if (f.epipolar) {
      const PixelRow row = epipolar_row(camera_now, camera_, f.sighting);
      rows.add(row.residual, row.jacobian);
    } else {
      const PixelRows pair = reprojection_rows(camera_now, camera_, f.sighting, f.whitening);
      rows.add(pair.residual[0], pair.jacobian.row(0), pair.residual[1], pair.jacobian.row(1));
    }
  }
}

void FeatureSet::judge(const std::vector<double>& weights) {
  for (std::size_t i = 0; i < features.size(); ++i) {
    Feature& f = features[i];
    f.inlier = weights[i] > 0.0;
    f.outlier_frames = f.inlier ? 0 : f.outlier_frames + 1;
  }
  std::erase_if(features, [](const Feature& f) { return f.outlier_frames >= kOutlierFramesToDrop; });
}

void FeatureSet::drop_riders(const Pose& reference_from_body, std::int64_t newest_ns) {
  ridden_.forget_before(newest_ns - kRiddenMemory_ns);
  const CameraMotion camera_now = motion(reference_from_body);
  std::erase_if(features, [&](Feature& f) {
    f.on_rig.add(evidence_of_riding(camera_now, camera_, f.sighting));
    if (f.on_rig.rides()) ridden_.add(newest_ns, f.pixel);
    return f.on_rig.rides();
  });
}

void FeatureSet::renew_anchor(const Pose& reference_from_body) {
  if (features.empty()) return;
  const CameraMotion camera_now = motion(reference_from_body);
  double change = 0.0;
  for (const Feature& f : features) {
    const Eigen::Matrix2d now_from_anchor = shape_of(camera_now, camera_, f) * f.anchor_shape.inverse();
    change += std::sqrt(0.5) * (now_from_anchor - Eigen::Matrix2d::Identity()).norm();
  }
  if (change > kAnchorMaxChange * static_cast<double>(features.size())) anchor_here(reference_from_body);
}

void FeatureSet::anchor_here(const Pose& reference_from_body) {
  const CameraMotion camera_now = motion(reference_from_body);
  source_.anchor_here();
  for (Feature& f : features) {
    const bool at_reference = f.pixel == f.reference_pixel;
    f.anchor_sigma = at_reference ? 0.0 : std::hypot(f.anchor_sigma, f.track_sigma);
    f.track_sigma = 0.0;
    f.anchor_pixel = f.pixel;
    f.anchor_shape = shape_of(camera_now, camera_, f);
  }
}

double FeatureSet::overlap() const {
  if (features.empty()) return 0.0;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  for (const Feature& f : features) shift += (f.pixel - f.reference_pixel).cast<double>();
  shift /= static_cast<double>(features.size());
  return (1.0 - std::abs(shift.x()) / camera_.width) * (1.0 - std::abs(shift.y()) / camera_.height);
}

void FeatureSet::make_newest_the_reference(const Pose& reference_from_body) {
  const CameraMotion camera_now = motion(reference_from_body);
  for (Feature& f : features) {
    f.triangulated = carried_along(f.triangulated, camera_now, f.sighting.keyframe_ray);
    f.anchor_shape *= shape_of(camera_now, camera_, f).inverse();
    f.plane = carried_along(f.plane, camera_now);
    f.sighting.keyframe_ray = ray_through(camera_, f.sighting.pixel);
    f.reference_pixel = f.pixel;
    f.anchor_sigma = f.track_sigma;
  }
}

void FeatureSet::refill() {
  std::vector<FeatureSource::Seen> present;
  present.reserve(features.size() + ridden_.pixels().size());
  for (const Feature& f : features) present.push_back({f.id, f.pixel});
  for (const Eigen::Vector2f& pixel : ridden_.pixels()) present.push_back({FeatureSource::kNoId, pixel});
  for (const FeatureSource::Fresh& fresh : source_.find_new(present, config_.corners)) {
    Feature f;
    f.id = fresh.id;
    f.pixel = f.reference_pixel = f.anchor_pixel = fresh.pixel;
    f.sighting.pixel = pinhole_pixel(camera_, fresh.pixel);
    f.sighting.keyframe_ray = ray_through(camera_, f.sighting.pixel);
    f.sighting.pixel_sigma = std::hypot(sigma_of_any_place(), fresh.noise_sigma_px);
    f.sighting.depth = kFarAway;
    features.push_back(f);
  }
}

void FeatureSet::add_depth_points(std::int64_t stamp_ns, DepthSource source,
                                  const std::vector<Eigen::Vector3f>& points_in_body, const Pose& world_from_body) {
  const Eigen::Isometry3f transform =
      Eigen::Translation3f(world_from_body.translation.cast<float>()) * world_from_body.rotation.cast<float>();
  std::vector<Eigen::Vector3f> points_in_world;
  points_in_world.reserve(points_in_body.size());
  for (const Eigen::Vector3f& p : points_in_body) points_in_world.push_back(transform * p);
  depth_map_.add(stamp_ns, source, points_in_world, world_from_body * body_from_camera_);
}

void FeatureSet::add_depth_image(const DepthFrame& frame, const Pose& world_from_body) {
  if (depth_image_ns_ && seconds_between(*depth_image_ns_, frame.stamp_ns) < kDepthImagePause_s) return;
  const FurtherCamera* further = further_camera(frame.camera_id);
  if (further == nullptr && frame.camera_id != 0) return;
  const CameraIntrinsics& camera = further != nullptr ? further->intrinsics : camera_;
  const Pose& body_from_camera = further != nullptr ? further->body_from_camera : body_from_camera_;
  depth_image_ns_ = frame.stamp_ns;
  std::vector<Eigen::Vector3f> points = depth_image_points(frame, camera, DepthMapConfig{}.angular_spacing_deg);
  for (Eigen::Vector3f& p : points) p = (body_from_camera * p.cast<double>()).cast<float>();
  add_depth_points(frame.stamp_ns, DepthSource::kDepthImage, points, world_from_body);
}

void FeatureSet::give_depth(const Pose& world_from_body, std::int64_t reference_ns) {
  depth_map_.look_from(world_from_body * body_from_camera_, reference_ns);
  for (Feature& f : features) {
    f.epipolar = false;
    f.depth_source = DepthSource::kNone;
    f.sighting.depth = kFarAway;
    f.plane.setZero();
    if (const auto depth = depth_map_.depth_along(f.sighting.keyframe_ray)) {
      f.depth_source = depth->source;
      f.sighting.depth = f.triangulated = depth->depth;
      f.plane = depth->plane;
    } else if (converged(f.triangulated)) {
      f.depth_source = DepthSource::kTriangulated;
      f.sighting.depth = f.triangulated;
      f.sighting.depth.sigma = std::hypot(f.triangulated.sigma, kMotionShare * f.triangulated.mean);
      f.plane = facing_plane(f.triangulated);
    }
  }
}

void FeatureSet::give_stereo_depth(const CameraFrame& right) {
  StereoDepth* stereo = stereo_with(right.camera_id);
  if (stereo == nullptr || source_.image().data == nullptr) return;
  const auto indices = without_map_depth();
  take_stereo_depths(indices, stereo->measure(source_.image(), right, as_seen_by_stereo(indices)));
}

void FeatureSet::give_stereo_depth(const PointFrame& right) {
  const StereoDepth* stereo = stereo_with(right.camera_id);
  if (stereo == nullptr) return;
  const auto indices = without_map_depth();
  take_stereo_depths(indices, stereo->measure(right, as_seen_by_stereo(indices)));
}

const FurtherCamera* FeatureSet::further_camera(int camera_id) const {
  const auto found = std::find_if(further_cameras_.begin(), further_cameras_.end(),
                                  [&](const FurtherCamera& camera) { return camera.camera_id == camera_id; });
  return found == further_cameras_.end() ? nullptr : &*found;
}

StereoDepth* FeatureSet::stereo_with(int camera_id) {
  const FurtherCamera* right = further_camera(camera_id);
  if (right == nullptr) return nullptr;
  if (!stereo_) stereo_.emplace(camera_, body_from_camera_, *right);
  return &*stereo_;
}

std::vector<std::size_t> FeatureSet::without_map_depth() const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const DepthSource source = features[i].depth_source;
    if (source == DepthSource::kNone || source == DepthSource::kTriangulated) indices.push_back(i);
  }
  return indices;
}

std::vector<StereoDepth::Feature> FeatureSet::as_seen_by_stereo(const std::vector<std::size_t>& indices) const {
  std::vector<StereoDepth::Feature> seen;
  for (const std::size_t i : indices) {
    const Feature& f = features[i];
    seen.push_back({f.id, f.pixel, f.sighting.keyframe_ray, sigma_of_any_place(), f.triangulated});
  }
  return seen;
}

void FeatureSet::take_stereo_depths(const std::vector<std::size_t>& indices,
                                    const std::vector<std::optional<InverseDepth>>& depths) {
  for (std::size_t k = 0; k < indices.size(); ++k) {
    if (!depths[k]) continue;
    Feature& f = features[indices[k]];
    f.triangulated = fuse(f.triangulated, *depths[k]);
    // Pairs of neighbouring images err alike: averaging many must not pretend otherwise.
    f.triangulated.sigma = std::max(f.triangulated.sigma, kLeastShareOfSigma * depths[k]->sigma);
    f.sighting.depth = f.triangulated;
    f.plane = facing_plane(f.triangulated);
    f.depth_source = DepthSource::kStereo;
  }
}

std::vector<TrackedFeature> FeatureSet::shown() const {
  std::vector<TrackedFeature> tracked;
  tracked.reserve(features.size());
  for (const Feature& f : features) {
    tracked.push_back({f.pixel, f.reference_pixel, shown_depth(f.depth_source), f.inlier});
  }
  return tracked;
}

}  // namespace plumbline
