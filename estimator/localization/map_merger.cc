#include "estimator/localization/map_merger.h"

#include <algorithm>
#include <cmath>

#include "estimator/lidar/direction_sampling.h"
#include "estimator/lidar/scan_matcher.h"
#include "estimator/localization/agreement_gate.h"
#include "estimator/localization/map_support.h"
#include "estimator/localization/occupancy.h"

namespace plumbline {
namespace {

constexpr int kMergePlaneBudget = 20'000;
constexpr int kMergeEdgeBudget = 4'000;
constexpr int kLeastSharedFeatures = 500;
constexpr int kRounds = 3;  // each with what the one before has brought near

// What maps of one place hold to: theirs err by a few centimetres each, and cells of the other's surface lie anywhere
// within a cell.
constexpr double kClose_m = 0.1;
constexpr double kLeastClose = 0.85;
constexpr double kLargestMedian_m = 0.05;
constexpr double kLargestCorrection_m = 2.0;
constexpr double kLargestCorrection_rad = 0.2;
// A wrong overlap has many fits, and which is found depends on the guess.
constexpr double kAside_m = 0.3;
constexpr double kAsGood = 0.7;  // of the support
constexpr double kLargestSpread_m = 0.05;

/// The features that lie near the other map, seen from their middle: levers about a far origin would couple rotation
/// with translation.
struct Overlap {
  FeatureCloud features;
  Pose b_from_middle;
  double share = 0.0;
};

Overlap overlap_of(const FeatureCloud& b, const Occupancy& a, const Pose& a_from_b) {
  const auto near = [&](const FeaturePoint& f) { return a.near(a_from_b * f.position.cast<double>()); };
  Overlap overlap;
  std::copy_if(b.planes.begin(), b.planes.end(), std::back_inserter(overlap.features.planes), near);
  std::copy_if(b.edges.begin(), b.edges.end(), std::back_inserter(overlap.features.edges), near);
  const std::size_t found = overlap.features.planes.size() + overlap.features.edges.size();
  const std::size_t all = b.planes.size() + b.edges.size();
  if (found == 0) return overlap;
  overlap.share = static_cast<double>(found) / static_cast<double>(all);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto* kind : {&overlap.features.planes, &overlap.features.edges}) {
    for (const FeaturePoint& f : *kind) sum += f.position.cast<double>();
  }
  overlap.b_from_middle.translation = sum / static_cast<double>(found);
  move(overlap.features, overlap.b_from_middle.inverse(), 0.0F);
  return overlap;
}

ScanMatcher matcher_on(const PriorMap& map) {
  ScanMatcherConfig config;
  config.largest_plane_disagreement = 1.0;
  config.plane_budget = kMergePlaneBudget;
  config.edge_budget = kMergeEdgeBudget;
  config.max_iterations = 20;
  ScanMatcher matcher(Calibration{}, config);
  matcher.insert(map.surfaces, Pose{}, /*path_m=*/0.0);
  return matcher;
}

/// From a guess that is not believed: it says where to look and no more.
PosePrior loose(const Pose& pose) { return {pose, Matrix6d::Identity()}; }

struct Fit {
  Pose a_from_b;
  Overlap overlap;
  SolveResult solved;
};

Fit fit(ScanMatcher& matcher, const PriorMap& b, const Occupancy& a, const Pose& guess) {
  Fit result;
  result.a_from_b = guess;
  for (int round = 0; round < kRounds; ++round) {
    result.overlap = overlap_of(b.surfaces, a, result.a_from_b);
    result.solved = matcher.match(result.overlap.features, loose(result.a_from_b * result.overlap.b_from_middle));
    result.a_from_b = result.solved.pose * result.overlap.b_from_middle.inverse();
  }
  return result;
}

/// The matcher keeps its rows as they are at its guess, which is the solution of the last round.
void add_residuals(ScanMatcher& matcher, const Fit& found, MapAlignment& alignment) {
  matcher.match(found.overlap.features, loose(found.solved.pose));
  std::vector<double> distances;
  for (const MatchRow& row : matcher.rows()) distances.push_back(std::abs(row.residual_m));
  if (distances.empty()) return;
  std::sort(distances.begin(), distances.end());
  const auto at = [&](double share) {
    return distances[static_cast<std::size_t>(share * static_cast<double>(distances.size() - 1))];
  };
  alignment.residual_median_m = at(0.5);
  alignment.residual_p95_m = at(0.95);
  const auto close = std::upper_bound(distances.begin(), distances.end(), kClose_m) - distances.begin();
  alignment.close_share = static_cast<double>(close) / static_cast<double>(distances.size());
}

double support_of(const ScanMatcher& matcher, const Fit& found) {
  if (matcher.rows().empty()) return 0.0;
  std::vector<FeaturePoint> planes;
  for (const std::uint32_t i : sample_by_direction(found.overlap.features.planes, kMergePlaneBudget)) {
    planes.push_back(found.overlap.features.planes[i]);
  }
  return map_support(plane_information(planes, matcher.rows().front().sigma_m, kNormalSigma),
                     found.solved.information_of_rows, ScanMatcherConfig{}.degeneracy_threshold);
}

/// How far off fits from other guesses end that are about as good. One that merely got stuck does not count.
double spread_of(ScanMatcher& matcher, const PriorMap& b, const Occupancy& a, const Fit& found, double support) {
  double largest = 0.0;
  for (const Eigen::Vector3d& aside : {Eigen::Vector3d(kAside_m, kAside_m, 0.0), Eigen::Vector3d(-kAside_m, 0.0, 0.1),
                                       Eigen::Vector3d(0.0, -kAside_m, -0.1)}) {
    Pose guess = found.a_from_b;
    guess.translation += aside;
    const Fit again = fit(matcher, b, a, guess);
    if (support_of(matcher, again) < kAsGood * support) continue;
    const Eigen::Vector3d middle = found.overlap.b_from_middle.translation;
    largest = std::max(largest, (again.a_from_b * middle - found.a_from_b * middle).norm());
  }
  return largest;
}

std::string centimetres(double metres) { return std::to_string(std::lround(100.0 * metres)) + " cm"; }

std::string refusal_of(const MapAlignment& m, const Fit& found) {
  const std::size_t features = found.overlap.features.planes.size() + found.overlap.features.edges.size();
  if (features < kLeastSharedFeatures)
    return "the maps do not overlap: " + std::to_string(features) + " features of B lie near A";
  if (m.well_conditioned < 6) {
    return "the overlap determines " + std::to_string(m.well_conditioned) + " of 6 directions";
  }
  if (m.correction_m > kLargestCorrection_m || m.correction_rad > kLargestCorrection_rad) {
    return "they fit only " + centimetres(m.correction_m) + " from where B was said to lie";
  }
  if (m.support < AgreementGate::kLeastSupport || m.close_share < kLeastClose ||
      m.residual_median_m > kLargestMedian_m) {
    return "their surfaces differ: only " + std::to_string(std::lround(100.0 * m.close_share)) +
           " % of the overlap lies on A, in the worst direction " + std::to_string(std::lround(100.0 * m.support)) +
           " %, half of it within " + centimetres(m.residual_median_m);
  }
  if (m.spread_m > kLargestSpread_m) {
    return "there is more than one fit: guesses " + centimetres(kAside_m) + " aside end " + centimetres(m.spread_m) +
           " apart";
  }
  return {};
}

}  // namespace

MapAlignment align_maps(const PriorMap& a, const PriorMap& b, const Pose& guess) {
  ScanMatcher matcher = matcher_on(a);
  const Occupancy occupancy(a.surfaces);
  const Fit found = fit(matcher, b, occupancy, guess);
  MapAlignment alignment;
  alignment.a_from_b = found.a_from_b;
  alignment.overlap = found.overlap.share;
  alignment.well_conditioned = found.solved.spectrum.well_conditioned;
  const Vector6d correction = (guess * found.overlap.b_from_middle).local(found.a_from_b * found.overlap.b_from_middle);
  alignment.correction_rad = correction.head<3>().norm();
  alignment.correction_m = correction.tail<3>().norm();
  add_residuals(matcher, found, alignment);
  alignment.support = support_of(matcher, found);
  if (alignment.well_conditioned == 6) alignment.spread_m = spread_of(matcher, b, occupancy, found, alignment.support);
  alignment.refusal = refusal_of(alignment, found);
  return alignment;
}

}  // namespace plumbline
