#include "estimator/lidar/sweep_odometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/geometry/so3.h"
#include "estimator/lidar/correspondence.h"
#include "estimator/lidar/direction_sampling.h"

namespace plumbline {
namespace {

constexpr int kPlaneBudget = 1200;
constexpr int kEdgeBudget = 500;
constexpr int kClutterBudget = 2500;
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
constexpr double kClearlyMore = 1.2;

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
  SweepConstraints(const PointTree& edges, const PointTree& planes, const PointTree& clutter,
                   const FeatureCloud& features, const Pose& predicted, double duration_s, double sigma_m,
                   double map_sigma_m)
      : edges_(edges),
        planes_(planes),
        clutter_(clutter),
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
    for (const FeaturePoint& f : features_.clutter) add_clutter(f, motion, rows);
    doubt_m_ = doubt_m_ > 0.05 ? 0.25 * doubt_m_ : 0.0;
  }

 private:
  double share_of(const FeaturePoint& f) const { return static_cast<double>(f.offset_s) / duration_s_; }

  void add_plane(const FeaturePoint& f, const LinearMotion& motion, ResidualRows& rows) const {
    const Eigen::Vector3d point = f.position.cast<double>();
    const Eigen::Vector3d placed = motion.place(point, share_of(f));
    NearestSamples nearest(kPlaneNeighbours, reach_of(f, doubt_m_), f.normal);
    planes_.search(placed, nearest);
    const auto plane = fit_plane(nearest, plane_limits_, placed);
    if (!plane) return;
    rows.add((plane->normal.dot(placed) - plane->offset) / sigma_m_,
             motion.jacobian(plane->normal, point, share_of(f)) / sigma_m_);
  }

  void add_line(const FeaturePoint& f, const LinearMotion& motion, ResidualRows& rows) const {
    NearestSamples nearest(kLineNeighbours, reach_of(f, doubt_m_), Eigen::Vector3f::Zero());
    edges_.search(motion.place(f.position.cast<double>(), share_of(f)), nearest);
    if (const auto line = fit_line(nearest, edge_limits_)) {
      add_line_rows(f, *line, std::hypot(sigma_m_, static_cast<double>(f.spread_m)), motion, rows);
    }
  }

  void add_clutter(const FeaturePoint& f, const LinearMotion& motion, ResidualRows& rows) const {
    NearestSamples nearest(kClutterNeighbours, kClutterReach_m + doubt_m_, Eigen::Vector3f::Zero());
    clutter_.search(motion.place(f.position.cast<double>(), share_of(f)), nearest);
    if (const auto line = line_through_clutter(nearest, f.normal.cast<double>())) {
      add_line_rows(f, *line, kClutterSigma_m, motion, rows);
    }
  }

  void add_line_rows(const FeaturePoint& f, const MapLine& line, double sigma_m, const LinearMotion& motion,
                     ResidualRows& rows) const {
    const Eigen::Vector3d point = f.position.cast<double>();
    const Eigen::Vector3d offset = motion.place(point, share_of(f)) - line.point;
    rows.add(line.across_1.dot(offset) / sigma_m, motion.jacobian(line.across_1, point, share_of(f)) / sigma_m,
             line.across_2.dot(offset) / sigma_m, motion.jacobian(line.across_2, point, share_of(f)) / sigma_m);
  }

  const PointTree& edges_;
  const PointTree& planes_;
  const PointTree& clutter_;
  const FeatureCloud& features_;
  const Pose& predicted_;
  double duration_s_;
  double sigma_m_;
  double doubt_m_ = 0.0;
  FitLimits plane_limits_;
  FitLimits edge_limits_;
};

FeatureCloud within_budget(const FeatureCloud& from, int effort) {
  return {every_nth(from.edges, effort * kEdgeBudget),
          pick(from.planes, sample_by_direction(from.planes, effort * kPlaneBudget)),
          every_nth(from.clutter, kClutterBudget)};
}

/// One solve from one guess to the next, over the same features.
class SweepSolve {
 public:
  SweepSolve(SweepConstraints constraints, const PosePrior& prior, double sigma_m, WeakDirections weak)
      : constraints_(std::move(constraints)), prior_(prior), sigma_m_(sigma_m) {
    options_.max_iterations = kMaxIterations;
    options_.rotation_tolerance = 1e-4;
    options_.translation_tolerance = 5e-4;
    options_.degeneracy_threshold = kDegeneracyThreshold;
    options_.weak = weak;
    options_.min_features = kLeastFeatures;
  }

  SolveResult from(const Pose& guess, double doubt_m) {
    options_.scale_floor = kUnitNoiseMad * (1.0 + doubt_m / sigma_m_);
    constraints_.start_with(doubt_m);
    return solve(
        guess, prior_, [&](const Pose& pose, ResidualRows& rows) { constraints_.linearize(pose, rows); }, options_);
  }

  /// Far from the solution the rows that would lead to it look like outliers. First all are believed.
  SolveResult widely() {
    const double doubt_m =
        std::min(kLargestDoubt_m, 2.0 * std::sqrt(prior_.covariance.bottomRightCorner<3, 3>().trace()));
    return from(doubt_m > kCoarseDoubt_m ? from(prior_.mean, doubt_m).pose : prior_.mean, 0.0);
  }

 private:
  SweepConstraints constraints_;
  const PosePrior& prior_;
  double sigma_m_;
  SolverOptions options_;
};

/// How many features agree with a solution.
double support_of(const SolveResult& solved) {
  return std::accumulate(solved.weights.begin(), solved.weights.end(), 0.0);
}

}  // namespace

Pose linear_share(const Pose& corrected, const Pose& predicted, double share) {
  return interpolate(Pose{}, corrected * predicted.inverse(), share);
}

SweepOdometry::SweepOdometry(const Calibration& calibration, WeakDirections weak)
    : sigma_m_(std::max(kLeastMatchSigma_m, std::sqrt(2.0) * calibration.lidar_range_sigma_m)),
      map_sigma_m_(0.5 * calibration.lidar_range_sigma_m),
      weak_(weak) {}

void SweepOdometry::begin(const FeatureCloud& last_sweep, std::int64_t reference_ns) {
  revise(last_sweep);
  reference_ns_ = reference_ns;
  begun_ = true;
  sweep_ = {};
}

void SweepOdometry::revise(const FeatureCloud& last_sweep) {
  edges_.build(samples_of(last_sweep.edges));
  planes_.build(samples_of(last_sweep.planes));
  clutter_.build(samples_of(last_sweep.clutter));
}

void SweepOdometry::add(const FeatureCloud& predicted_in_reference) {
  const auto append = [](std::vector<FeaturePoint>& to, const std::vector<FeaturePoint>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(sweep_.edges, predicted_in_reference.edges);
  append(sweep_.planes, predicted_in_reference.planes);
  append(sweep_.clutter, predicted_in_reference.clutter);
}

SolveResult SweepOdometry::solve(std::int64_t now_ns, const PosePrior& reference_from_body,
                                 const std::optional<Pose>& likely, int effort) const {
  const FeatureCloud used = within_budget(sweep_, effort);
  SweepSolve solve(SweepConstraints(edges_, planes_, clutter_, used, reference_from_body.mean,
                                    seconds_between(reference_ns_, now_ns), sigma_m_, map_sigma_m_),
                   reference_from_body, sigma_m_, weak_);
  const SolveResult afresh = solve.widely();
  if (!likely) return afresh;
  const SolveResult onwards = solve.from(*likely, 0.0);
  return support_of(onwards) > kClearlyMore * support_of(afresh) ? onwards : afresh;
}

SolveResult SweepOdometry::refine(std::int64_t now_ns, const PosePrior& reference_from_body, const Pose& known,
                                  int effort) const {
  const FeatureCloud used = within_budget(sweep_, effort);
  SweepSolve solve(SweepConstraints(edges_, planes_, clutter_, used, reference_from_body.mean,
                                    seconds_between(reference_ns_, now_ns), sigma_m_, map_sigma_m_),
                   reference_from_body, sigma_m_, weak_);
  return solve.from(known, 0.0);
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
  correct(cloud.clutter);
  return cloud;
}

}  // namespace plumbline
