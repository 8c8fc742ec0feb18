#include "estimator/solver/detectors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include "estimator/geometry/so3.h"
#include "estimator/geometry/symmetric_eigen.h"

namespace plumbline {
namespace {

using Block = Eigen::Matrix3d;

constexpr std::size_t kLeastRows = 6;
constexpr double kTiny = 1e-12;

/// Sum of weight * v v^T over the rows.
Matrix6d information(const std::vector<MatchRow>& rows, const std::function<double(const MatchRow&)>& weight) {
  Matrix6d sum = Matrix6d::Zero();
  for (const MatchRow& row : rows) {
    const Vector6d v = row.jacobian();
    sum.noalias() += weight(row) * v * v.transpose();
  }
  return sum;
}

double robust(const MatchRow& row) { return row.weight; }

void sort(Detection& detection) {
  std::vector<std::size_t> order(detection.scores.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return detection.scores[a] < detection.scores[b]; });
  Detection sorted;
  for (const std::size_t i : order) {
    sorted.scores.push_back(detection.scores[i]);
    sorted.directions.push_back(detection.directions[i]);
  }
  detection = std::move(sorted);
}

/// Eigenpairs of the whole matrix, each scored.
Detection of_eigenpairs(const Matrix6d& matrix, const std::function<double(double, const Vector6d&)>& score) {
  const SymmetricEigen<Matrix6d> eigen(matrix);
  Detection detection;
  for (int i = 0; i < 6; ++i) {
    detection.scores.push_back(score(std::max(0.0, eigen.values[i]), eigen.vectors.col(i)));
    detection.directions.emplace_back(eigen.vectors.col(i));
  }
  sort(detection);
  return detection;
}

double largest_eigenvalue(const Matrix6d& matrix) {
  return std::max(kTiny, SymmetricEigen<Matrix6d>(matrix).values[5]);
}

enum class Part { kRotation, kTranslation };

Vector6d in_part(Part part, const Eigen::Vector3d& v) {
  Vector6d whole = Vector6d::Zero();
  whole.segment<3>(part == Part::kRotation ? 0 : 3) = v;
  return whole;
}

/// Eigenpairs of a rotation and a translation block, each scored within its block.
Detection of_blocks(const Block& rotation, const Block& translation,
                    const std::function<double(Part, double value, double largest, const Eigen::Vector3d&)>& score) {
  Detection detection;
  for (const Part part : {Part::kRotation, Part::kTranslation}) {
    const SymmetricEigen<Block> eigen(part == Part::kRotation ? rotation : translation);
    for (int i = 0; i < 3; ++i) {
      const double largest = std::max(kTiny, eigen.values[2]);
      detection.scores.push_back(score(part, std::max(0.0, eigen.values[i]), largest, eigen.vectors.col(i)));
      detection.directions.push_back(in_part(part, eigen.vectors.col(i)));
    }
  }
  sort(detection);
  return detection;
}

Detection imce(const std::vector<MatchRow>& rows) {
  double squares = 0.0;
  for (const MatchRow& row : rows) squares += row.whitened_weight() * row.residual_m * row.residual_m;
  const double variance = squares / static_cast<double>(rows.size() - kLeastRows + 1);
  return of_eigenpairs(information(rows, &MatchRow::whitened_weight),
                       [&](double value, const Vector6d&) { return value / std::max(variance, kTiny); });
}

Detection sub_block(const std::vector<MatchRow>& rows) {
  double mean_range_m = 0.0;
  for (const MatchRow& row : rows) mean_range_m += row.point.norm() / static_cast<double>(rows.size());
  const Matrix6d h = information(rows, &MatchRow::whitened_weight);
  const double range_squared = std::max(kTiny, mean_range_m * mean_range_m);
  return of_blocks(h.topLeftCorner<3, 3>() / range_squared, h.bottomRightCorner<3, 3>(),
                   [](Part, double value, double, const Eigen::Vector3d&) { return value; });
}

Detection schur(const std::vector<MatchRow>& rows) {
  const Matrix6d h = information(rows, robust);
  const Block rr = h.topLeftCorner<3, 3>();
  const Block tt = h.bottomRightCorner<3, 3>();
  const Block rt = h.topRightCorner<3, 3>();
  const auto pseudo_inverse = [](const Block& block) -> Block {
    const SymmetricEigen<Block> eigen(block);
    const double least = 1e-9 * std::max(kTiny, eigen.values[2]);
    const Eigen::Vector3d inverse =
        eigen.values.unaryExpr([&](double value) { return value > least ? 1.0 / value : 0.0; });
    return eigen.vectors * inverse.asDiagonal() * eigen.vectors.transpose();
  };
  return of_blocks(rr - rt * pseudo_inverse(tt) * rt.transpose(), tt - rt.transpose() * pseudo_inverse(rr) * rt,
                   [](Part, double value, double largest, const Eigen::Vector3d&) { return value / largest; });
}

/// A row's share in a block: the normal, or the turning arm about the centre of the points, at most of length 1.
Eigen::Vector3d share_in(Part part, const MatchRow& row, const Eigen::Vector3d& centre) {
  if (part == Part::kTranslation) return row.normal;
  const Eigen::Vector3d arm = (row.point - centre).cross(row.normal);
  return arm.norm() >= 1.0 ? arm.normalized() : arm;
}

Eigen::Vector3d centre_of(const std::vector<MatchRow>& rows) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const MatchRow& row : rows) centre += row.point / static_cast<double>(rows.size());
  return centre;
}

/// Contributions along the eigenvectors of each block: of all rows but those nearly square to it, and of those strongly
/// aligned; a direction is localisable when either reaches its limit, so that here one is the limit.
Detection x_icp(const std::vector<MatchRow>& rows) {
  constexpr double kCombined = 300.0;
  constexpr double kHigh = 150.0;
  const double least = std::cos(80.0 * std::numbers::pi / 180.0);
  const double high = std::cos(45.0 * std::numbers::pi / 180.0);
  const Eigen::Vector3d centre = centre_of(rows);
  const auto block_of = [&](Part part) {
    Block sum = Block::Zero();
    for (const MatchRow& row : rows) {
      const Eigen::Vector3d f = share_in(part, row, centre);
      sum += f * f.transpose();
    }
    return sum;
  };
  return of_blocks(block_of(Part::kRotation), block_of(Part::kTranslation),
                   [&](Part part, double, double, const Eigen::Vector3d& v) {
                     double combined = 0.0;
                     double aligned = 0.0;
                     for (const MatchRow& row : rows) {
                       const double share = std::abs(share_in(part, row, centre).dot(v));
                       if (share >= least) combined += share;
                       if (share > high) aligned += share;
                     }
                     return std::max(combined / kCombined, aligned / kHigh);
                   });
}

Detection coin_lio(const std::vector<MatchRow>& rows) {
  Block tt = Block::Zero();
  for (const MatchRow& row : rows) tt += row.normal * row.normal.transpose();
  const SymmetricEigen<Block> eigen(tt);
  Detection detection;
  for (int i = 0; i < 3; ++i) {
    double sum = 0.0;
    for (const MatchRow& row : rows) {
      const double share = std::abs(row.normal.dot(eigen.vectors.col(i)));
      if (share > 0.5) sum += share;
    }
    detection.scores.push_back(sum);
    detection.directions.push_back(in_part(Part::kTranslation, eigen.vectors.col(i)));
  }
  sort(detection);
  return detection;
}

/// The noise of points and normals makes the matrix larger than its signal by M = sum of w B N B^T on average; along a
/// direction, whether the signal stands out by the factor s is a matter of the normal distribution. The score is its
/// argument, so that 0 is an even chance and nothing saturates.
Detection drpm(const std::vector<MatchRow>& rows, double range_sigma_m) {
  constexpr double kSignalOverNoise = 10.0;
  // A normal is fitted to ten neighbours spread over 0.25 m: its tilt is their noise over sqrt(10) times that.
  const double tilt_sigma = range_sigma_m / (std::sqrt(10.0) * 0.25);
  Matrix6d noise = Matrix6d::Zero();  // of (point, normal)
  noise.diagonal() << Eigen::Vector3d::Constant(range_sigma_m * range_sigma_m),
      Eigen::Vector3d::Constant(tilt_sigma * tilt_sigma);
  const auto covariance_of = [&](const MatchRow& row) -> Matrix6d {
    Matrix6d b = Matrix6d::Zero();
    b.topLeftCorner<3, 3>() = -skew(row.normal);
    b.topRightCorner<3, 3>() = skew(row.point);
    b.bottomRightCorner<3, 3>().setIdentity();
    return b * noise * b.transpose();
  };
  const Matrix6d h = information(rows, &MatchRow::whitened_weight);
  return of_eigenpairs(h, [&](double value, const Vector6d& u) {
    double mean = 0.0;
    double variance = 0.0;
    for (const MatchRow& row : rows) {
      const double w = row.whitened_weight();
      const double a = w * u.dot(covariance_of(row) * u);
      const double b = u.dot(row.jacobian()) * std::sqrt(w);
      mean += a;
      variance += 2.0 * a * a + 4.0 * a * b * b;
    }
    return (value / (1.0 + kSignalOverNoise) - mean) / std::sqrt(std::max(variance, kTiny));
  });
}

Detection none(Detector detector) {
  const int count = detector == Detector::kCoinLio ? 3 : 6;
  Detection detection;
  for (int i = 0; i < count; ++i) {
    detection.scores.push_back(0.0);
    detection.directions.emplace_back(Vector6d::Unit(6 - count + i));
  }
  return detection;
}

bool usable(const std::vector<MatchRow>& rows) {
  const bool finite = std::all_of(rows.begin(), rows.end(), [](const MatchRow& row) {
    return row.point.allFinite() && row.normal.allFinite() && std::isfinite(row.residual_m) &&
           std::isfinite(row.weight) && row.sigma_m > 0.0;
  });
  return finite && rows.size() >= kLeastRows;
}

}  // namespace

Vector6d MatchRow::jacobian() const {
  Vector6d v;
  v << point.cross(normal), normal;
  return v;
}

std::string_view to_string(Detector detector) {
  switch (detector) {
    case Detector::kD:
      return "d";
    case Detector::kImce:
      return "imce";
    case Detector::kIcn:
      return "icn";
    case Detector::kCondition:
      return "condition";
    case Detector::kNormalised:
      return "normalised";
    case Detector::kSubBlock:
      return "sub_block";
    case Detector::kSchur:
      return "schur";
    case Detector::kXicp:
      return "x_icp";
    case Detector::kCoinLio:
      return "coin_lio";
    case Detector::kDrpm:
      break;
  }
  return "drpm";
}

Detection detect(Detector detector, const std::vector<MatchRow>& rows, double range_sigma_m) {
  if (!usable(rows)) return none(detector);
  switch (detector) {
    case Detector::kD:
      return of_eigenpairs(information(rows, &MatchRow::whitened_weight),
                           [](double value, const Vector6d&) { return value + 1.0; });
    case Detector::kImce:
      return imce(rows);
    case Detector::kIcn: {
      const Matrix6d h = information(rows, &MatchRow::whitened_weight);
      const double largest = largest_eigenvalue(h);
      return of_eigenpairs(h, [&](double value, const Vector6d&) { return std::sqrt(value / largest); });
    }
    case Detector::kCondition: {
      const Matrix6d h = information(rows, [](const MatchRow&) { return 1.0; });
      const double largest = largest_eigenvalue(h);
      return of_eigenpairs(h, [&](double value, const Vector6d&) { return value / largest; });
    }
    case Detector::kNormalised: {
      const Matrix6d h = information(rows, robust);
      return of_eigenpairs(h, [&](double value, const Vector6d&) { return value / std::max(kTiny, h.trace()); });
    }
    case Detector::kSubBlock:
      return sub_block(rows);
    case Detector::kSchur:
      return schur(rows);
    case Detector::kXicp:
      return x_icp(rows);
    case Detector::kCoinLio:
      return coin_lio(rows);
    case Detector::kDrpm:
      break;
  }
  return drpm(rows, range_sigma_m);
}

}  // namespace plumbline
