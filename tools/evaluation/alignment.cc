#include "tools/evaluation/alignment.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr std::int64_t kFirstSecondNs = 1'000'000'000;

/// The rotation that maximises trace(R^T m): the nearest to a sum of rotations or of outer products.
Eigen::Quaterniond nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) sign(2, 2) = -1.0;
  return Eigen::Quaterniond(svd.matrixU() * sign * svd.matrixV().transpose()).normalized();
}

/// The rotation about the vertical that maximises the same trace.
Eigen::Quaterniond nearest_yaw(const Eigen::Matrix3d& m) {
  const double yaw = std::atan2(m(1, 0) - m(0, 1), m(0, 0) + m(1, 1));
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
}

struct Moments {
  Eigen::Vector3d truth_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d estimate_mean = Eigen::Vector3d::Zero();
  double truth_variance = 0.0;
  double estimate_variance = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of truth with estimate
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Zero();    ///< mean of R_truth R_estimate^T
};

Moments moments_of(const std::vector<PosePair>& pairs) {
  Moments m;
  const double share = 1.0 / static_cast<double>(pairs.size());
  for (const PosePair& pair : pairs) {
    m.truth_mean += share * pair.truth.translation;
    m.estimate_mean += share * pair.estimate.translation;
    m.attitude += share * (pair.truth.rotation * pair.estimate.rotation.conjugate()).toRotationMatrix();
  }
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d truth = pair.truth.translation - m.truth_mean;
    const Eigen::Vector3d estimate = pair.estimate.translation - m.estimate_mean;
    m.truth_variance += share * truth.squaredNorm();
    m.estimate_variance += share * estimate.squaredNorm();
    m.covariance += share * truth * estimate.transpose();
  }
  return m;
}

Alignment align_whole(const std::vector<PosePair>& pairs, AlignmentKind kind, double attitude_weight) {
  const Moments m = moments_of(pairs);
  // A resting truth has no extent, and then the attitudes alone decide.
  const double weight = std::max(attitude_weight * attitude_weight * m.truth_variance, 1e-12);
  const Eigen::Matrix3d evidence = m.covariance + weight * m.attitude;

  Alignment result;
  result.truth_from_estimate.rotation =
      kind == AlignmentKind::kYaw ? nearest_yaw(evidence) : nearest_rotation(evidence);
  if (kind == AlignmentKind::kSim3 && m.estimate_variance > 0.0) {
    // Umeyama eq. 42: tr(D S) / sigma_x^2, where tr(D S) = tr(R^T Sigma_xy).
    const Eigen::Matrix3d r = result.truth_from_estimate.rotation.toRotationMatrix();
    const double scale = (r.transpose() * m.covariance).trace() / m.estimate_variance;
    if (scale > 0.0) result.scale = scale;
  }
  result.truth_from_estimate.translation =
      m.truth_mean - result.scale * (result.truth_from_estimate.rotation * m.estimate_mean);
  return result;
}

}  // namespace

Pose Alignment::apply(const Pose& estimate) const {
  return {(truth_from_estimate.rotation * estimate.rotation).normalized(),
          scale * (truth_from_estimate.rotation * estimate.translation) + truth_from_estimate.translation};
}

std::optional<AlignmentKind> alignment_kind(const std::string& name) {
  if (name == "none") return AlignmentKind::kNone;
  if (name == "origin") return AlignmentKind::kOrigin;
  if (name == "yaw") return AlignmentKind::kYaw;
  if (name == "se3") return AlignmentKind::kSe3;
  if (name == "sim3") return AlignmentKind::kSim3;
  return std::nullopt;
}

Pose align_first_second(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) return {};
  const auto end = std::find_if(pairs.begin(), pairs.end(), [&](const PosePair& pair) {
    return pair.stamp_ns > pairs.front().stamp_ns + kFirstSecondNs;
  });
  const Moments m = moments_of({pairs.begin(), end});
  Pose truth_from_estimate;
  truth_from_estimate.rotation = nearest_rotation(m.attitude);
  truth_from_estimate.translation = m.truth_mean - truth_from_estimate.rotation * m.estimate_mean;
  return truth_from_estimate;
}

Alignment align(const std::vector<PosePair>& pairs, AlignmentKind kind, double attitude_weight) {
  if (pairs.empty() || kind == AlignmentKind::kNone) return {};
  if (kind == AlignmentKind::kOrigin) return {pairs.front().truth * pairs.front().estimate.inverse(), 1.0};
  return align_whole(pairs, kind, attitude_weight);
}

Pose place_on_site(const std::vector<PosePair>& pairs) {
  constexpr double kVerticalWeight = 0.1;
  return align(pairs, AlignmentKind::kSe3, kVerticalWeight).truth_from_estimate;
}

}  // namespace plumbline
