#include "estimator/localization/agreement_gate.h"

namespace plumbline {
namespace {

constexpr double kLeastOverlap = 0.35;
constexpr double kLeastInliers = 0.85;

// A start is known to a metre and ten degrees; after that, odometry's drift at four sigma, lost or not: the next match
// within ten degrees of a place lost over a field was a wrong one.
constexpr double kStart_m = 1.0;
constexpr double kStart_rad = 0.17;
constexpr double kSigmas = 4.0;
// Matches of one map differ by centimetres.
constexpr double kSame_m = 0.1;
constexpr double kSame_rad = 0.015;

constexpr int kRefusalsUntilLost = 3;

}  // namespace

MapAgreement AgreementGate::shape(const MatchEvidence& evidence) const {
  if (evidence.overlap < kLeastOverlap) return MapAgreement::kOffMap;
  if (evidence.well_conditioned == 0) return MapAgreement::kUndetermined;
  const double least_support = found_ ? least_support_.once_found : least_support_.at_start;
  if (evidence.support < least_support || evidence.inlier_share < kLeastInliers) return MapAgreement::kDisagrees;
  return MapAgreement::kAgrees;
}

bool AgreementGate::confirms(const Pose& map_from_body, const Pose& odometry_from_body) const {
  if (!candidate_) return false;
  const Vector6d apart = (*candidate_ * odometry_from_body).local(map_from_body);
  return apart.tail<3>().norm() < kSame_m && apart.head<3>().norm() < kSame_rad;
}

bool AgreementGate::too_far(const Pose& map_from_body, const Pose& odometry_from_body) const {
  const OdometryDrift drift;
  const Vector6d apart = (held_ * odometry_from_body).local(map_from_body);
  const double start_m = found_ ? 0.0 : kStart_m;
  const double start_rad = found_ ? 0.0 : kStart_rad;
  return apart.tail<3>().norm() > start_m + kSigmas * drift.translation_sigma(way_) ||
         apart.head<3>().norm() > start_rad + kSigmas * drift.rotation_sigma(way_);
}

MapAgreement AgreementGate::judge(const MatchEvidence& evidence, const OdometryReading& odometry) {
  const OdometryReading last = last_.value_or(odometry);
  last_ = odometry;
  const Pose& odometry_from_body = odometry.odometry_from_body;
  way_.travelled_m += (odometry_from_body.translation - last.odometry_from_body.translation).norm();
  way_.blind_m += odometry.blind_m - last.blind_m;

  MapAgreement agreement = shape(evidence);
  const Pose& map_from_body = evidence.map_from_body;
  if (agreement == MapAgreement::kAgrees && too_far(map_from_body, odometry_from_body)) {
    agreement = MapAgreement::kTooFar;
  }
  if (agreement != MapAgreement::kAgrees) {
    candidate_.reset();
    if (++refused_ >= kRefusalsUntilLost) localized_ = false;
    return agreement;
  }
  const Pose map_from_odometry = map_from_body * odometry_from_body.inverse();
  if (!localized_ && !confirms(map_from_body, odometry_from_body)) {
    candidate_ = map_from_odometry;
    return MapAgreement::kUnconfirmed;
  }
  candidate_.reset();
  held_ = map_from_odometry;
  localized_ = found_ = true;
  refused_ = 0;
  way_ = {};
  return MapAgreement::kAgrees;
}

}  // namespace plumbline
