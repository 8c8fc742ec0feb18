#include "estimator/localization/map_support.h"

#include <algorithm>

#include "estimator/geometry/symmetric_eigen.h"
#include "estimator/solver/degeneracy.h"

namespace plumbline {
std::vector<FeaturePoint> planes_near(const std::vector<FeaturePoint>& planes, const Occupancy& map,
                                      const Pose& map_from_body) {
  std::vector<FeaturePoint> near;
  std::copy_if(planes.begin(), planes.end(), std::back_inserter(near),
               [&](const FeaturePoint& f) { return map.near(map_from_body * f.position.cast<double>()); });
  return near;
}

Matrix6d plane_information(const std::vector<FeaturePoint>& planes_in_body, double sigma_m, double normal_sigma) {
  Matrix6d information = Matrix6d::Zero();
  for (const FeaturePoint& f : planes_in_body) {
    const Eigen::Vector3d normal = f.normal.cast<double>();
    Vector6d row;
    row << f.position.cast<double>().cross(normal), normal;
    information += row * row.transpose();
    const Eigen::Vector3d across_1 = normal.unitOrthogonal();
    for (const Eigen::Vector3d& across : {across_1, Eigen::Vector3d(normal.cross(across_1))}) {
      row << f.position.cast<double>().cross(across), across;
      information -= normal_sigma * normal_sigma * row * row.transpose();
    }
  }
  return information / (sigma_m * sigma_m);
}

double map_support(const Matrix6d& expected, const Matrix6d& borne_out, double degeneracy_threshold) {
  const Spectrum spectrum = analyse(expected, degeneracy_threshold);
  if (spectrum.well_conditioned == 0 || !borne_out.allFinite()) return 0.0;
  const Eigen::MatrixXd whitened =
      spectrum.eigenvectors.rightCols(spectrum.well_conditioned) *
      spectrum.eigenvalues.tail(spectrum.well_conditioned).cwiseSqrt().cwiseInverse().asDiagonal();
  const SymmetricEigen<Eigen::MatrixXd> eigen(whitened.transpose() * borne_out * whitened);
  return eigen.converged ? std::clamp(eigen.values[0], 0.0, 1.0) : 0.0;
}

}  // namespace plumbline
