#include "estimator/localization/map_localizer.h"

#include <vector>

#include "estimator/lidar/direction_sampling.h"
#include "estimator/localization/map_support.h"
#include "estimator/pipeline/module_health.h"

namespace plumbline {
namespace {

// A stack covers more of the scene than a scan, so more features are worth their time, twice a second at most.
constexpr int kStackPlaneBudget = 2000;
constexpr int kStackEdgeBudget = 400;
// A step below these changes nothing that a map of centimetres could tell.
constexpr double kRotationTolerance = 2e-4;
constexpr double kTranslationTolerance = 2e-3;

// The rows of one stack share the errors of map and odometry, which do not average out.
constexpr double kInflation = 100.0;

// Measured: of what a stack finds on itself, a map made by a level lidar bears out a half for one that looks 45 degrees
// down, and next to all for its like; three metres along a hall it is a quarter. Foliage bears out 0.04 to 0.15.
constexpr AgreementGate::LeastSupport kLeastSupport{0.35, 0.03};

// A third of what AgreementGate lets pass.
constexpr double kStartSigma_rad = 0.06;
constexpr double kStartSigma_m = 0.3;

ScanMatcherConfig stack_matcher_config() {
  ScanMatcherConfig config;
  config.largest_plane_disagreement = 1.0;
  config.plane_budget = kStackPlaneBudget;
  config.edge_budget = kStackEdgeBudget;
  config.rotation_tolerance = kRotationTolerance;
  config.translation_tolerance = kTranslationTolerance;
  return config;
}

PosePrior prior_at(const Pose& predicted, const OdometryWay& way, bool found) {
  const OdometryDrift drift;
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(drift.rotation_sigma(way)),
      Eigen::Vector3d::Constant(drift.translation_sigma(way));
  if (!found) {
    sigma.head<3>().array() += kStartSigma_rad;
    sigma.tail<3>().array() += kStartSigma_m;
  }
  return {predicted, sigma.cwiseAbs2().asDiagonal()};
}

/// Of a stack's planes, those that it finds on itself, with the normals that it finds them by: what a map of the same
/// place would bear out, too. A leaf has a normal, but not one that a second look would find.
std::vector<FeaturePoint> found_on_itself(const std::vector<FeaturePoint>& planes, const FeatureCloud& stack,
                                          const Calibration& calibration) {
  ScanMatcherConfig config = stack_matcher_config();
  config.max_iterations = 1;
  ScanMatcher itself(calibration, config);
  itself.insert({{}, stack.planes, {}}, Pose{}, /*path_m=*/0.0);
  itself.match({{}, planes, {}}, {Pose{}, 1e-12 * Matrix6d::Identity()});
  std::vector<FeaturePoint> found;
  for (const MatchRow& row : itself.rows()) {
    FeaturePoint f;
    f.position = row.point.cast<float>();
    f.normal = row.normal.cast<float>();
    found.push_back(f);
  }
  return found;
}

}  // namespace

MapLocalizer::MapLocalizer(const Calibration& calibration, const PriorMap& map, const Pose& map_from_start,
                           bool remapping)
    : calibration_(calibration),
      matcher_(calibration, stack_matcher_config(), weak_directions(remapping)),
      occupancy_(map.surfaces),
      gate_(map_from_start, kLeastSupport) {
  matcher_.insert(map.surfaces, Pose{}, /*path_m=*/0.0);
}

MatchEvidence MapLocalizer::evidence_of(const FeatureCloud& stack, const SolveResult& solved) const {
  MatchEvidence evidence;
  evidence.map_from_body = solved.pose;
  evidence.well_conditioned = solved.spectrum.well_conditioned;
  evidence.overlap = occupancy_.share_near(stack, solved.pose);
  if (matcher_.rows().empty() || solved.features == 0) return evidence;
  evidence.inlier_share = static_cast<double>(solved.inliers) / static_cast<double>(solved.features);
  // The same sample that the matcher takes.
  std::vector<FeaturePoint> planes;
  for (const std::uint32_t i : sample_by_direction(stack.planes, kStackPlaneBudget)) planes.push_back(stack.planes[i]);
  planes = planes_near(planes, occupancy_, solved.pose);
  const Matrix6d expected =
      plane_information(found_on_itself(planes, stack, calibration_), matcher_.rows().front().sigma_m, kNormalSigma);
  evidence.support = map_support(expected, solved.information_of_rows, ScanMatcherConfig{}.degeneracy_threshold);
  return evidence;
}

MapFix MapLocalizer::locate(std::int64_t stamp_ns, const FeatureCloud& stack, const OdometryReading& odometry) {
  const StopWatch watch;
  const Pose predicted = gate_.expected_map_from_odometry() * odometry.odometry_from_body;
  const SolveResult solved = matcher_.match(stack, prior_at(predicted, gate_.way(), gate_.found()));
  const MatchEvidence evidence = evidence_of(stack, solved);
  MapFix fix;
  fix.health = health_of(stamp_ns, Module::kLocalization, solved, predicted, watch.seconds());
  fix.covariance = kInflation * determined_covariance(solved);
  fix.match.stamp_ns = stamp_ns;
  fix.match.agreement = gate_.judge(evidence, odometry);
  fix.match.overlap = evidence.overlap;
  fix.match.support = evidence.support;
  fix.match.correction_rad = fix.health.correction.head<3>().norm();
  fix.match.correction_m = fix.health.correction.tail<3>().norm();
  fix.match.iterations = solved.iterations;
  fix.match.processing_s = fix.health.processing_s;
  return fix;
}

}  // namespace plumbline
