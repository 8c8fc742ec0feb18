#include "estimator/lidar/scan_matcher.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "estimator/lidar/correspondence.h"
#include "estimator/lidar/direction_sampling.h"
#include "estimator/lidar/voxel_map.h"

namespace plumbline {
namespace {

// Neighbours are looked for within a metre, or as far as two rings 2 degrees apart lie at the feature's range.
constexpr double kLeastReach_m = 1.0;
constexpr double kLargestReach_m = 1.5;
constexpr double kReachPerRange = 0.07;

constexpr double kLeastRange_m = 0.5;  // nearer features would let a beam turn without bound

// Correspondences are found anew only when the pose has moved this far since: searching is nearly all of a match's
// cost, and planes a decimetre apart on one surface are the same plane.
constexpr double kSearchAgain_m = 0.02;
constexpr double kSearchAgain_rad = 0.003;

// A data sheet's accuracy does not say how much of it averages out. A quarter of its variance is taken for a bias that
// all returns share, a quarter for one of each ring; a match solves for a ring's whole bias.
constexpr double kBiasShare = 0.5;
constexpr double kWholeBias = std::numbers::sqrt2;

// What biases bend, they go on bending the same way while the scene keeps its kind: along a tunnel of 200 m, over a
// field, across a plain. The gyroscope can hold attitude for so long, so that attitude is told of all of it (of 10, 30
// and 100 renewals). Nothing holds place for more than a second or two in the dark, and a drift that lasts, taken for
// so much noise, would have it let go of the map: 54 % more error in a second of a dark corridor.
constexpr double kAlikeRenewals = 30.0;
constexpr double kAlikeShifts = 10.0;         // by what each renewal bends
constexpr double kAlikeShiftsPerMetre = 1.0;  // by what creeps with the motion

constexpr double kClutterResolution_m = 0.1;  // as dense as the scan gives it

struct PlaneMatch {
  Eigen::Vector3d point_in_body;
  Eigen::Vector3d beam;  ///< unit, in B
  MapPlane plane;
  int laser;
};

struct LineMatch {
  Eigen::Vector3d point_in_body;
  Eigen::Vector3d beam;
  MapLine line;
  double sigma_m;
  int laser;
};

/// Finds what features lie on in the map.
struct MapSearch {
  const VoxelMap& edges;
  const VoxelMap& planes;
  const VoxelMap& clutter;
  const FitLimits& edge_limits;
  const FitLimits& plane_limits;
  double resolution_factor;

  double reach_of(const FeaturePoint& feature) const {
    const double range_m = feature.position.cast<double>().norm();
    return resolution_factor * std::clamp(kReachPerRange * range_m, kLeastReach_m, kLargestReach_m);
  }

  std::optional<MapPlane> plane_of(const FeaturePoint& feature, const Pose& world_from_body) const {
    const Eigen::Vector3d at = world_from_body * feature.position.cast<double>();
    const Eigen::Vector3d normal = world_from_body.rotation * feature.normal.cast<double>();
    const double reach_m = reach_of(feature);
    NearestSamples nearest(kPlaneNeighbours, reach_m, normal.cast<float>());
    planes.nearest(at, reach_m, nearest);
    return fit_plane(nearest, plane_limits, at);
  }

  std::optional<MapLine> edge_of(const FeaturePoint& feature, const Pose& world_from_body) const {
    const double reach_m = reach_of(feature);
    NearestSamples nearest(kLineNeighbours, reach_m, Eigen::Vector3f::Zero());
    edges.nearest(world_from_body * feature.position.cast<double>(), reach_m, nearest);
    return fit_line(nearest, edge_limits);
  }

  std::optional<MapLine> clutter_of(const FeaturePoint& feature, const Pose& world_from_body) const {
    const double reach_m = resolution_factor * kClutterReach_m;
    NearestSamples nearest(kClutterNeighbours, reach_m, Eigen::Vector3f::Zero());
    clutter.nearest(world_from_body * feature.position.cast<double>(), reach_m, nearest);
    return line_through_clutter(nearest, world_from_body.rotation * feature.normal.cast<double>());
  }
};

double edge_sigma_m(const FeaturePoint& feature, double sigma_m) {
  return std::hypot(sigma_m, static_cast<double>(feature.spread_m));
}

int coarser(int budget, double resolution_factor) { return static_cast<int>(std::lround(budget / resolution_factor)); }

/// @param pose_of  a feature's world_from_body
template <typename PoseOf>
std::vector<Eigen::Vector3d> in_world(const std::vector<FeaturePoint>& features, PoseOf pose_of) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(features.size());
  for (const FeaturePoint& f : features) points.push_back(pose_of(f) * f.position.cast<double>());
  return points;
}

}  // namespace

struct ScanMatcher::Impl {
  Impl(const Calibration& calibration, const ScanMatcherConfig& settings, WeakDirections weak)
      : config(settings),
        sigma_m(std::max(kLeastMatchSigma_m, std::sqrt(2.0) * calibration.lidar_range_sigma_m)),
        bias_sigma_m(kBiasShare * calibration.lidar_range_sigma_m),
        biases(kWholeBias * bias_sigma_m),
        body_from_lidar(calibration.body_from_lidar),
        edges(coarser_map(settings, settings.edge_resolution_m)),
        planes(coarser_map(settings, settings.plane_resolution_m)),
        clutter(coarser_map(settings, kClutterResolution_m)),
        recorded_edges(settings.coarse_voxel_m, settings.edge_resolution_m),
        recorded_planes(settings.coarse_voxel_m, settings.plane_resolution_m) {
    options.max_iterations = settings.max_iterations;
    options.rotation_tolerance = settings.rotation_tolerance;
    options.translation_tolerance = settings.translation_tolerance;
    options.degeneracy_threshold = settings.degeneracy_threshold;
    options.weak = weak;
    options.min_features = settings.least_features;
    edge_limits.largest_residual_m = 0.03;
    plane_limits.map_sigma_m = edge_limits.map_sigma_m = 0.5 * calibration.lidar_range_sigma_m;
    edge_limits.largest_tilt_sigma = settings.largest_edge_tilt;
    plane_limits.largest_tilt_sigma = settings.largest_plane_tilt;
    plane_limits.largest_disagreement = settings.largest_plane_disagreement;
  }

  /// For searches near these features. @param pose_of  a feature's world_from_body
  template <typename PoseOf>
  void prepare(const FeatureCloud& features, PoseOf pose_of) {
    edges.prepare(in_world(features.edges, pose_of));
    planes.prepare(in_world(features.planes, pose_of));
    clutter.prepare(in_world(features.clutter, pose_of));
  }

  MapSearch search() const { return {edges, planes, clutter, edge_limits, plane_limits, config.resolution_factor}; }

  static VoxelMap coarser_map(const ScanMatcherConfig& settings, double resolution_m) {
    return {settings.resolution_factor * settings.coarse_voxel_m, settings.resolution_factor * resolution_m};
  }

  ScanMatcherConfig config;
  double sigma_m;
  double bias_sigma_m;  ///< of the bias that all share, and of the part that is a ring's own
  RangeBiases biases;
  std::vector<SharedEstimate> matched_biases;  ///< of the last match
  Pose body_from_lidar;
  SolverOptions options;
  FitLimits plane_limits;
  FitLimits edge_limits;
  MatchDrift drift;
  VoxelMap edges;
  VoxelMap planes;
  VoxelMap clutter;
  VoxelMap recorded_edges;
  VoxelMap recorded_planes;
  std::vector<MatchRow> rows;  ///< of the last match
};

namespace {

/// The linearizer of one match: finds correspondences at a pose and stacks their rows (thesis 5.13-5.15).
class MapConstraints {
 public:
  MapConstraints(const MapSearch& map, double sigma_m, double bias_sigma_m, const RangeBiases& biases,
                 const Eigen::Vector3d& lidar_in_body, const FeatureCloud& features)
      : map_(map),
        sigma_m_(sigma_m),
        bias_sigma_m_(bias_sigma_m),
        biases_(biases),
        lidar_in_body_(lidar_in_body),
        features_(features) {
    plane_matches_.reserve(features.planes.size());
    line_matches_.reserve(features.edges.size() + features.clutter.size());
  }

  void linearize(const Pose& world_from_body, ResidualRows& rows) {
    if (!searched_ || moved_far(world_from_body)) search(world_from_body);
    for (const PlaneMatch& m : plane_matches_) {
      add_plane_row(m.point_in_body, m.plane, world_from_body, sigma_m_, rows);
      rows.share(m.laser, biases_.sigma_m(m.laser) * m.beam);
    }
    for (const LineMatch& m : line_matches_) {
      add_line_rows(m.point_in_body, m.line, world_from_body, m.sigma_m, rows);
      rows.share(m.laser, biases_.sigma_m(m.laser) * m.beam);
    }
  }

  /// The rows that linearize() stacked last, not yet weighted: one per plane, then two per line.
  std::vector<MatchRow> match_rows(const Pose& world_from_body) const {
    const Eigen::Quaterniond body_from_world = world_from_body.rotation.conjugate();
    std::vector<MatchRow> rows;
    rows.reserve(plane_matches_.size() + 2 * line_matches_.size());
    for (const PlaneMatch& m : plane_matches_) {
      const double distance_m = m.plane.normal.dot(world_from_body * m.point_in_body) - m.plane.offset;
      rows.push_back({m.point_in_body, body_from_world * m.plane.normal, distance_m, sigma_m_, 1.0});
    }
    for (const LineMatch& m : line_matches_) {
      const Eigen::Vector3d off = world_from_body * m.point_in_body - m.line.point;
      for (const Eigen::Vector3d& across : {m.line.across_1, m.line.across_2}) {
        rows.push_back({m.point_in_body, body_from_world * across, across.dot(off), m.sigma_m, 1.0});
      }
    }
    return rows;
  }
  std::size_t plane_count() const { return plane_matches_.size(); }

  /// To first order: J^T of the rows times their change per metre of motion and bias, summed over each ring, since all
  /// of a ring err alike, and over all; less what the solution takes for the ring's bias.
  MatchDrift drift(const SolveResult& solved) {
    ResidualRows rows;
    linearize(solved.pose, rows);
    const int n = solved.spectrum.well_conditioned;
    if (n == 0 || static_cast<int>(solved.weights.size()) < rows.feature_count()) return {};
    using Gain = Eigen::Matrix<double, 6, 3>;
    struct Ring {
      Gain gain = Gain::Zero();                                 ///< J^T of the rows times their change as beams turn
      Eigen::RowVector3d turning = Eigen::RowVector3d::Zero();  ///< the same of the bias
      Vector6d pull = Vector6d::Zero();                         ///< J^T of the rows times their change by the bias
      double information = 0.0;                                 ///< on the bias
    };
    std::map<int, Ring> rings;
    double square_sum = 0.0;
    for (int f = 0; f < rows.feature_count(); ++f) {
      const auto [point, beam] = feature(static_cast<std::size_t>(f));
      const double range = std::max((point - lidar_in_body_).norm(), kLeastRange_m);
      square_sum += range * range;
      Ring& ring = rings[rows.group(f)];
      const Eigen::Matrix3d beam_turns = (Eigen::Matrix3d::Identity() - beam * beam.transpose()) / range;
      const double weight = solved.weights[static_cast<std::size_t>(f)];
      const double own_sigma_m = biases_.sigma_m(rows.group(f)) / kWholeBias;
      // A row's derivative by the position is its derivative by the feature's.
      for (int r = rows.first_row(f); r < rows.end_row(f); ++r) {
        const Eigen::RowVector3d turning = own_sigma_m * rows.jacobian(r).tail<3>().transpose() * beam_turns;
        ring.gain += weight * rows.jacobian(r) * turning;
        ring.turning += weight * rows.d_shared(r) * turning;
        ring.pull += weight * rows.d_shared(r) * rows.jacobian(r);
        ring.information += weight * rows.d_shared(r) * rows.d_shared(r);
      }
    }
    const Eigen::MatrixXd basis = solved.spectrum.eigenvectors.rightCols(n);
    const Matrix6d pose_of_gradient =
        basis * (basis.transpose() * solved.information * basis).ldlt().solve(Eigen::MatrixXd(basis.transpose()));
    if (!pose_of_gradient.allFinite()) return {};
    MatchDrift drift;
    drift.reach_m = std::sqrt(square_sum / rows.feature_count());
    Gain of_all = Gain::Zero();
    for (const auto& [group, ring] : rings) {
      const double unsolved = 1.0 / (ring.information + 1.0);
      drift.per_metre.push_back(pose_of_gradient * (ring.gain - unsolved * ring.pull * ring.turning));
      drift.per_renewal.push_back(unsolved * pose_of_gradient * ring.pull);
      // What all share is told from no ring's own: learning does not lessen it.
      of_all += kWholeBias * bias_sigma_m_ / biases_.sigma_m(group) * drift.per_metre.back();
    }
    drift.per_metre.push_back(of_all);
    return drift;
  }

 private:
  /// Point and beam, in the order of the rows.
  std::pair<Eigen::Vector3d, Eigen::Vector3d> feature(std::size_t at) const {
    if (at < plane_matches_.size()) return {plane_matches_[at].point_in_body, plane_matches_[at].beam};
    const LineMatch& line = line_matches_[at - plane_matches_.size()];
    return {line.point_in_body, line.beam};
  }

  Eigen::Vector3d beam_to(const Eigen::Vector3d& point_in_body) const {
    return (point_in_body - lidar_in_body_).normalized();
  }

  bool moved_far(const Pose& pose) const {
    const Vector6d moved = searched_at_.local(pose);
    return moved.head<3>().norm() > kSearchAgain_rad || moved.tail<3>().norm() > kSearchAgain_m;
  }

  void search(const Pose& world_from_body) {
    searched_ = true;
    searched_at_ = world_from_body;
    plane_matches_.clear();
    line_matches_.clear();
    for (const FeaturePoint& f : features_.planes) match_plane(f, world_from_body);
    for (const FeaturePoint& f : features_.edges) {
      match_line(f, map_.edge_of(f, world_from_body), edge_sigma_m(f, sigma_m_));
    }
    for (const FeaturePoint& f : features_.clutter) {
      match_line(f, map_.clutter_of(f, world_from_body), kClutterSigma_m);
    }
  }

  void match_plane(const FeaturePoint& feature, const Pose& world_from_body) {
    const auto plane = map_.plane_of(feature, world_from_body);
    if (!plane) return;
    const Eigen::Vector3d point = feature.position.cast<double>();
    plane_matches_.push_back({point, beam_to(point), *plane, feature.laser});
  }

  void match_line(const FeaturePoint& feature, const std::optional<MapLine>& line, double sigma_m) {
    if (!line) return;
    const Eigen::Vector3d point = feature.position.cast<double>();
    line_matches_.push_back({point, beam_to(point), *line, sigma_m, feature.laser});
  }

  MapSearch map_;
  double sigma_m_;
  double bias_sigma_m_;
  const RangeBiases& biases_;
  Eigen::Vector3d lidar_in_body_;
  const FeatureCloud& features_;
  bool searched_ = false;
  Pose searched_at_;
  std::vector<PlaneMatch> plane_matches_;
  std::vector<LineMatch> line_matches_;
};

}  // namespace

ScanMatcher::ScanMatcher(const Calibration& calibration, const ScanMatcherConfig& config, WeakDirections weak)
    : impl_(std::make_unique<Impl>(calibration, config, weak)) {}
ScanMatcher::ScanMatcher(ScanMatcher&&) noexcept = default;
ScanMatcher& ScanMatcher::operator=(ScanMatcher&&) noexcept = default;
ScanMatcher::~ScanMatcher() = default;

SolveResult ScanMatcher::match(const FeatureCloud& features, const PosePrior& world_from_body,
                               const Linearizer& further_rows) {
  Impl& m = *impl_;
  const double factor = m.config.resolution_factor;
  const int plane_budget = coarser(m.config.plane_budget, factor);
  const FeatureCloud used = {every_nth(features.edges, coarser(m.config.edge_budget, factor)),
                             pick(features.planes, sample_by_direction(features.planes, plane_budget)),
                             every_nth(features.clutter, coarser(m.config.clutter_budget, factor))};
  m.prepare(used, [&](const FeaturePoint&) { return world_from_body.mean; });
  MapConstraints constraints(m.search(), m.sigma_m, m.bias_sigma_m, m.biases, m.body_from_lidar.translation, used);
  m.rows.clear();
  std::size_t planes = 0;
  SolveResult solved = solve(
      world_from_body.mean, world_from_body,
      [&](const Pose& pose, ResidualRows& rows) {
        constraints.linearize(pose, rows);
        if (m.rows.empty()) {
          m.rows = constraints.match_rows(pose);
          planes = constraints.plane_count();
        }
        if (further_rows) further_rows(pose, rows);
      },
      m.options);
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    const std::size_t feature = i < planes ? i : planes + (i - planes) / 2;
    m.rows[i].weight = feature < solved.weights_at_guess.size() ? solved.weights_at_guess[feature] : 0.0;
  }
  m.drift = constraints.drift(solved);
  m.matched_biases = solved.shared;
  return solved;
}

void ScanMatcher::constrain(const FeatureCloud& features, const std::function<Pose(double offset_s)>& world_from_body,
                            ResidualRows& rows, std::vector<double>& measured_s) {
  Impl& m = *impl_;
  const auto pose_of = [&](const FeaturePoint& f) { return world_from_body(static_cast<double>(f.offset_s)); };
  m.prepare(features, pose_of);
  const MapSearch search = m.search();
  for (const FeaturePoint& f : features.planes) {
    const Pose pose = pose_of(f);
    const auto plane = search.plane_of(f, pose);
    if (!plane) continue;
    add_plane_row(f.position.cast<double>(), *plane, pose, m.sigma_m, rows);
    measured_s.push_back(static_cast<double>(f.offset_s));
  }
  const auto add_line = [&](const FeaturePoint& f, const std::optional<MapLine>& line, const Pose& pose,
                            double sigma_m) {
    if (!line) return;
    add_line_rows(f.position.cast<double>(), *line, pose, sigma_m, rows);
    measured_s.push_back(static_cast<double>(f.offset_s));
  };
  for (const FeaturePoint& f : features.edges) {
    const Pose pose = pose_of(f);
    add_line(f, search.edge_of(f, pose), pose, edge_sigma_m(f, m.sigma_m));
  }
  for (const FeaturePoint& f : features.clutter) {
    const Pose pose = pose_of(f);
    add_line(f, search.clutter_of(f, pose), pose, kClutterSigma_m);
  }
}

void ScanMatcher::learn_range_biases(double step_m) {
  Impl& m = *impl_;
  if (m.drift.reach_m > 0.0) m.biases.learn(m.matched_biases, std::min(1.0, step_m / m.drift.reach_m));
  m.matched_biases.clear();
}

const RangeBiases& ScanMatcher::range_biases() const { return impl_->biases; }

const MatchDrift& ScanMatcher::drift() const { return impl_->drift; }

Matrix6d MatchDrift::covariance(const Eigen::Vector3d& step_in_body) const {
  const double step_m = step_in_body.norm();
  Matrix6d sum = Matrix6d::Zero();
  if (step_m <= 0.0 || reach_m <= 0.0) return sum;
  const auto add = [&](Vector6d drift, double shifts_alike) {
    const double renewals_per_step = step_m / reach_m;
    drift.head<3>() *= std::sqrt(std::max(1.0, kAlikeRenewals / renewals_per_step));
    drift.tail<3>() *= std::sqrt(std::max(1.0, shifts_alike / renewals_per_step));
    sum += drift * drift.transpose();
  };
  for (const Vector6d& renewal : per_renewal) add(step_m / reach_m * renewal, kAlikeShifts);
  for (const Eigen::Matrix<double, 6, 3>& d : per_metre) add(d * step_in_body, kAlikeShiftsPerMetre);
  return sum;
}

const std::vector<MatchRow>& ScanMatcher::rows() const { return impl_->rows; }

void ScanMatcher::insert(const FeatureCloud& features, const Pose& map_from_body, double path_m,
                         const std::optional<Pose>& world_from_body) {
  Impl& m = *impl_;
  const double oldest_m = path_m - m.config.memory_path_m;
  m.edges.forget_before(oldest_m);
  m.planes.forget_before(oldest_m);
  m.clutter.forget_before(oldest_m);
  const auto merge = [&](const std::vector<FeaturePoint>& points, const Pose& target_from_body, VoxelMap& map) {
    const Eigen::Matrix3f rotation = target_from_body.rotation.toRotationMatrix().cast<float>();
    for (const FeaturePoint& f : points) {
      map.insert({target_from_body * f.position.cast<double>(), rotation * f.normal}, f.intensity, path_m);
    }
  };
  merge(features.edges, map_from_body, m.edges);
  merge(features.planes, map_from_body, m.planes);
  for (const FeaturePoint& f : features.clutter) {
    m.clutter.insert({map_from_body * f.position.cast<double>(), Eigen::Vector3f::Zero()}, f.intensity, path_m);
  }
  const Pose& recorded = world_from_body ? *world_from_body : map_from_body;
  merge(features.edges, recorded, m.recorded_edges);
  merge(features.planes, recorded, m.recorded_planes);
}

std::vector<MapPoint> ScanMatcher::map() const {
  std::vector<MapPoint> points;
  impl_->recorded_edges.collect(points);
  impl_->recorded_planes.collect(points);
  return points;
}

}  // namespace plumbline
