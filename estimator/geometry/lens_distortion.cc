#include "estimator/geometry/lens_distortion.h"

#include <Eigen/LU>

namespace plumbline {
namespace {

Eigen::Matrix2d d_distorted_d_ideal(const LensDistortion& lens, const Eigen::Vector2d& ideal) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (lens.k1 + r2 * lens.k2);
  const double slope = 2.0 * (lens.k1 + 2.0 * lens.k2 * r2);  // d radial / d(r^2), twice
  const double mixed = slope * x * y + 2.0 * lens.p1 * x + 2.0 * lens.p2 * y;
  Eigen::Matrix2d d;
  d << radial + slope * x * x + 2.0 * lens.p1 * y + 6.0 * lens.p2 * x, mixed,  //
      mixed, radial + slope * y * y + 6.0 * lens.p1 * y + 2.0 * lens.p2 * x;
  return d;
}

}  // namespace

Eigen::Vector2d distort(const LensDistortion& lens, const Eigen::Vector2d& ideal) {
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (lens.k1 + r2 * lens.k2);
  return {x * radial + 2.0 * lens.p1 * x * y + lens.p2 * (r2 + 2.0 * x * x),
          y * radial + lens.p1 * (r2 + 2.0 * y * y) + 2.0 * lens.p2 * x * y};
}

Eigen::Vector2d undistort(const LensDistortion& lens, const Eigen::Vector2d& distorted) {
  constexpr int kMostIterations = 20;
  constexpr double kTolerance = 1e-12;
  Eigen::Vector2d ideal = distorted;
  for (int i = 0; i < kMostIterations; ++i) {
    const Eigen::Vector2d error = distorted - distort(lens, ideal);
    if (error.squaredNorm() < kTolerance * kTolerance) break;
    ideal += d_distorted_d_ideal(lens, ideal).inverse() * error;
  }
  return ideal;
}

}  // namespace plumbline
