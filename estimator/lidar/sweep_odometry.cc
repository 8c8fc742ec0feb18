#include "estimator/lidar/sweep_odometry.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/so3.h"
#include "estimator/lidar/correspondence.h"
#include "estimator/lidar/direction_sampling.h"

namespace plumbline {
namespace {

constexpr int kPlaneBudget = 1200;
constexpr int kEdgeBudget = 200;
constexpr int kLeastFeatures = 50;
constexpr int kMaxIterations = 15;
// On whitened J^T J, as in scan matching: 1.4 cm of standard deviation.
constexpr double kDegeneracyThreshold = 5000.0;

// Neighbours are looked for as far as two lines 4.5 degrees apart lie at the feature's range, and further by what the
// prediction may be wrong; that part shrinks from one search to the next.
constexpr double kLeastLineReach_m = 1.0;
constexpr double kLargestLineReach_m = 2.0;
constexpr double kLineReachPerRange = 0.1;
constexpr double kLargestDoubt_m = 4.0;
constexpr double kCoarseDoubt_m = 0.1;
constexpr double kUnitNoiseMad = 0.6745;

double reach_of(const FeaturePoint& feature, double doubt_m) {
  const double range = feature.position.cast<double>().norm();
  return doubt_m + std::clamp(kLineReachPerRange * range, kLeastLineReach_m, kLargestLineReach_m);
}

std::vector<MapSample> samples_of(const std::vector<FeaturePoint>& features) {
  std::vector<MapSample> samples;
  samples.reserve(features.size());
  for (const FeaturePoint& f : features) samples.push_back({f.position.cast<double>(), f.normal});
  return samples;
}

/// The motion that is linear in time, and how the newest pose's perturbation moves a feature (4.5, 4.6).
class LinearMotion {
 public:
  LinearMotion(const Pose& predicted, const Pose& reference_from_body)
      : predicted_(predicted),
        pose_(reference_from_body),
        correction_(reference_from_body * predicted.inverse()),
        turn_(log_so3(correction_.rotation)),
        inverse_jacobian_(right_jacobian_so3(turn_).inverse()),
        predicted_rotation_(predicted.rotation.toRotationMatrix()) {}

  Eigen::Vector3d place(const Eigen::Vector3d& point, double share) const {
    return exp_so3(share * turn_) * point + share * correction_.translation;
  }

  /// Of direction . place(point, share), with respect to a right perturbation of the newest pose.
  Vector6d jacobian(const Eigen::Vector3d& direction, const Eigen::Vector3d& point, double share) const {
    const Eigen::Vector3d in_point_frame = exp_so3(share * turn_).conjugate() * direction;
    const Eigen::Vector3d in_prediction = correction_.rotation.conjugate() * direction;
    const Eigen::Matrix3d d_turn = share * right_jacobian_so3(share * turn_) * inverse_jacobian_;
    const Eigen::Vector3d d_correction =
        d_turn.transpose() * point.cross(in_point_frame) + share * in_prediction.cross(predicted_.translation);
    Vector6d jacobian;
    jacobian << predicted_rotation_.transpose() * d_correction, share * (pose_.rotation.conjugate() * direction);
    return jacobian;
  }

 private:
  const Pose& predicted_;
  const Pose& pose_;
  Pose correction_;
  Eigen::Vector3d turn_;
  Eigen::Matrix3d inverse_jacobian_;
  Eigen::Matrix3d predicted_rotation_;
};

/// The linearizer of one solve: correspondences anew at every iteration, as Algorithm 2 has it.
class SweepConstraints {
 public:
  SweepConstraints(const PointTree& edges, const PointTree& planes, const FeatureCloud& features, const Pose& predicted,
                   double duration_s, double sigma_m, double map_sigma_m)
      : edges_(edges),
        planes_(planes),
        features_(features),
        predicted_(predicted),
        duration_s_(duration_s),
        sigma_m_(sigma_m) {
    plane_limits_.map_sigma_m = edge_limits_.map_sigma_m = map_sigma_m;
    edge_limits_.largest_residual_m = 0.03;
    edge_limits_.largest_tilt_sigma = 0.05;
    plane_limits_.largest_tilt_sigma = 0.05;
  }

  void start_with(double doubt_m) { doubt_m_ = doubt_m; }

  void linearize(const Pose& reference_from_body, ResidualRows& rows) {
    const LinearMotion motion(predicted_, reference_from_body);
    for (const FeaturePoint& f : features_.planes) add_plane(f, motion, rows);
    for (const FeaturePoint& f : features_.edges) add_line(f, motion, rows);
    doubt_m_ = doubt_m_ > 0.05 ? 0.25 * doubt_m_ : 0.0;
  }

 private:
  double share_of(const FeaturePoint& f) const { return static_cast<double>(f.offset_s) / duration_s_; }

  void add_plane(const FeaturePoint& f, const LinearMotion& motion, ResidualRows& rows) const {
    const Eigen::Vector3d point = f.position.cast<double>();
    const Eigen::Vector3d placed = motion.place(point, share_of(f));
    NearestSamples nearest(kPlaneNeighbours, reach_of(f, doubt_m_), f.normal);
    planes_.search(placed, nearest);
    const auto plane = fit_plane(nearest, plane_limits_);
    if (!plane) return;
    rows.add((plane->normal.dot(placed) - plane->offset) / sigma_m_,
             motion.jacobian(plane->normal, point, share_of(f)) / sigma_m_);
  }

  void add_line(const FeaturePoint& f, const LinearMotion& motion, ResidualRows& rows) const {
    const Eigen::Vector3d point = f.position.cast<double>();
    const Eigen::Vector3d placed = motion.place(point, share_of(f));
    NearestSamples nearest(kLineNeighbours, reach_of(f, doubt_m_), Eigen::Vector3f::Zero());
    edges_.search(placed, nearest);
    const auto line = fit_line(nearest, edge_limits_);
    if (!line) return;
    const double sigma_m = std::hypot(sigma_m_, static_cast<double>(f.spread_m));
    const Eigen::Vector3d offset = placed - line->point;
    rows.add(line->across_1.dot(offset) / sigma_m, motion.jacobian(line->across_1, point, share_of(f)) / sigma_m,
             line->across_2.dot(offset) / sigma_m, motion.jacobian(line->across_2, point, share_of(f)) / sigma_m);
  }

  const PointTree& edges_;
  const PointTree& planes_;
  const FeatureCloud& features_;
  const Pose& predicted_;
  double duration_s_;
  double sigma_m_;
  double doubt_m_ = 0.0;
  FitLimits plane_limits_;
  FitLimits edge_limits_;
};

FeatureCloud within_budget(const FeatureCloud& from, int effort) {
  FeatureCloud used;
  const std::size_t edges = std::min(from.edges.size(), static_cast<std::size_t>(effort * kEdgeBudget));
  used.edges.reserve(edges);
  for (std::size_t k = 0; k < edges; ++k) used.edges.push_back(from.edges[k * from.edges.size() / edges]);
  const std::vector<std::uint32_t> picked = sample_by_direction(from.planes, effort * kPlaneBudget);
  used.planes.reserve(picked.size());
  for (const std::uint32_t i : picked) used.planes.push_back(from.planes[i]);
  return used;
}

}  // namespace

Pose linear_share(const Pose& corrected, const Pose& predicted, double share) {
  return interpolate(Pose{}, corrected * predicted.inverse(), share);
}

SweepOdometry::SweepOdometry(const Calibration& calibration, bool remapping)
    : sigma_m_(std::max(kLeastMatchSigma_m, std::sqrt(2.0) * calibration.lidar_range_sigma_m)),
      map_sigma_m_(0.5 * calibration.lidar_range_sigma_m),
      remapping_(remapping) {}

void SweepOdometry::begin(const FeatureCloud& last_sweep, std::int64_t reference_ns) {
  revise(last_sweep);
  reference_ns_ = reference_ns;
  begun_ = true;
  sweep_ = {};
}

void SweepOdometry::revise(const FeatureCloud& last_sweep) {
  edges_.build(samples_of(last_sweep.edges));
  planes_.build(samples_of(last_sweep.planes));
}

void SweepOdometry::add(const FeatureCloud& predicted_in_reference) {
  const auto append = [](std::vector<FeaturePoint>& to, const std::vector<FeaturePoint>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(sweep_.edges, predicted_in_reference.edges);
  append(sweep_.planes, predicted_in_reference.planes);
}

SolveResult SweepOdometry::solve(std::int64_t now_ns, const PosePrior& reference_from_body,
                                 const std::optional<Pose>& known, int effort) const {
  SolverOptions options;
  options.max_iterations = kMaxIterations;
  options.rotation_tolerance = 1e-4;
  options.translation_tolerance = 5e-4;
  options.degeneracy_threshold = kDegeneracyThreshold;
  options.remapping = remapping_;
  options.min_features = kLeastFeatures;
  const FeatureCloud used = within_budget(sweep_, effort);
  const Pose& predicted = reference_from_body.mean;
  SweepConstraints constraints(edges_, planes_, used, predicted, seconds_between(reference_ns_, now_ns), sigma_m_,
                               map_sigma_m_);
  const auto solve_from = [&](const Pose& guess, double doubt_m) {
    options.scale_floor = kUnitNoiseMad * (1.0 + doubt_m / sigma_m_);
    constraints.start_with(doubt_m);
    return plumbline::solve(
        guess, reference_from_body, [&](const Pose& pose, ResidualRows& rows) { constraints.linearize(pose, rows); },
        options);
  };
  if (known) return solve_from(*known, 0.0);
  // Far from the solution the rows that would lead to it look like outliers. First all are believed.
  const double doubt_m =
      std::min(kLargestDoubt_m, 2.0 * std::sqrt(reference_from_body.covariance.bottomRightCorner<3, 3>().trace()));
  return solve_from(doubt_m > kCoarseDoubt_m ? solve_from(predicted, doubt_m).pose : predicted, 0.0);
}

FeatureCloud SweepOdometry::corrected(std::int64_t now_ns, const Pose& predicted,
                                      const Pose& reference_from_body) const {
  const double duration_s = seconds_between(reference_ns_, now_ns);
  const Pose body_from_reference = reference_from_body.inverse();
  FeatureCloud cloud = sweep_;
  const auto correct = [&](std::vector<FeaturePoint>& features) {
    for (FeaturePoint& f : features) {
      const double share = static_cast<double>(f.offset_s) / duration_s;
      const Pose body_from_predicted = body_from_reference * linear_share(reference_from_body, predicted, share);
      f.position = (body_from_predicted * f.position.cast<double>()).cast<float>();
      f.normal = body_from_predicted.rotation.cast<float>() * f.normal;
    }
  };
  correct(cloud.edges);
  correct(cloud.planes);
  return cloud;
}

}  // namespace plumbline
