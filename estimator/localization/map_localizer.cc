#include "estimator/localization/map_localizer.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "estimator/pipeline/module_health.h"

namespace plumbline {
namespace {

// A stack covers more of the scene than a scan, so more features are worth their time, twice a second at most.
constexpr int kPlaneBudget = 2000;
constexpr int kEdgeBudget = 400;
// A step below these changes nothing that a map of centimetres could tell.
constexpr double kRotationTolerance = 2e-4;
constexpr double kTranslationTolerance = 2e-3;

// Rows within this many sigma lie on the map; sigma is at least two centimetres (see ScanMatcher).
constexpr double kCloseSigmas = 4.0;

// The rows of one stack share the errors of map and odometry, which do not average out.
constexpr double kInflation = 100.0;

ScanMatcherConfig matcher_config() {
  ScanMatcherConfig config;
  config.plane_budget = kPlaneBudget;
  config.edge_budget = kEdgeBudget;
  config.rotation_tolerance = kRotationTolerance;
  config.translation_tolerance = kTranslationTolerance;
  return config;
}

std::size_t offered(const FeatureCloud& stack) {
  return std::min<std::size_t>(stack.planes.size(), kPlaneBudget) +
         std::min<std::size_t>(stack.edges.size(), kEdgeBudget);
}

PosePrior prior_at(const Pose& predicted, double travelled_m) {
  const OdometryDrift drift;
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(drift.rotation_sigma(travelled_m)),
      Eigen::Vector3d::Constant(drift.translation_sigma(travelled_m));
  return {predicted, sigma.cwiseAbs2().asDiagonal()};
}

/// A bisquare weight tells its row's residual: w = (1 - (r / cut)^2)^2, thesis 4.11, leverage left out.
int count_close(const SolveResult& solved) {
  constexpr double kBisquareCut = 6.9459;
  const double alpha = kCloseSigmas / (kBisquareCut * solved.scale);
  const double kept = std::max(0.0, 1.0 - alpha * alpha);
  return static_cast<int>(std::count_if(solved.weights.begin(), solved.weights.end(),
                                        [&](double weight) { return weight > 0.0 && weight >= kept * kept; }));
}

MatchEvidence evidence_of(const SolveResult& solved, std::size_t features) {
  MatchEvidence evidence;
  evidence.map_from_body = solved.pose;
  evidence.well_conditioned = solved.spectrum.well_conditioned;
  if (features == 0) return evidence;
  evidence.overlap = static_cast<double>(solved.features) / static_cast<double>(features);
  evidence.close_share = static_cast<double>(count_close(solved)) / static_cast<double>(features);
  return evidence;
}

Matrix6d covariance_of(const SolveResult& solved) {
  const int n = solved.spectrum.well_conditioned;
  if (n == 0) return Matrix6d::Zero();
  const Eigen::MatrixXd basis = solved.spectrum.eigenvectors.rightCols(n);
  const Eigen::MatrixXd reduced = basis.transpose() * solved.information * basis / kInflation;
  return basis * reduced.ldlt().solve(Eigen::MatrixXd(basis.transpose()));
}

}  // namespace

MapLocalizer::MapLocalizer(const Calibration& calibration, const PriorMap& map, const Pose& map_from_start,
                           bool remapping)
    : matcher_(calibration, matcher_config(), remapping), gate_(map_from_start) {
  matcher_.insert(map.surfaces, Pose{}, /*path_m=*/0.0);
}

MapFix MapLocalizer::locate(std::int64_t stamp_ns, const FeatureCloud& stack, const Pose& odometry_from_body) {
  const StopWatch watch;
  const Pose predicted = gate_.expected_map_from_odometry() * odometry_from_body;
  const SolveResult solved = matcher_.match(stack, prior_at(predicted, gate_.travelled_m()));
  const MatchEvidence evidence = evidence_of(solved, offered(stack));
  MapFix fix;
  fix.health = health_of(stamp_ns, Module::kLocalization, solved, predicted, watch.seconds());
  fix.covariance = covariance_of(solved);
  fix.match.stamp_ns = stamp_ns;
  fix.match.agreement = gate_.judge(evidence, odometry_from_body);
  fix.match.overlap = evidence.overlap;
  fix.match.close_share = evidence.close_share;
  fix.match.correction_rad = fix.health.correction.head<3>().norm();
  fix.match.correction_m = fix.health.correction.tail<3>().norm();
  fix.match.iterations = solved.iterations;
  fix.match.processing_s = fix.health.processing_s;
  return fix;
}

}  // namespace plumbline
