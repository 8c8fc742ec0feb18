#include "sensors/lidar_footprint.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

constexpr double kGoldenAngle = std::numbers::pi * 2.0 * (2.0 - std::numbers::phi);

}  // namespace

LidarFootprint::LidarFootprint(const LidarModel& model)
    : half_exit_m_(0.5 * model.exit_width_m, 0.5 * model.exit_height_m),
      half_divergence_rad_(0.5 * model.divergence_horizontal_rad, 0.5 * model.divergence_vertical_rad) {
  for (int shift = 0; shift < kShifts; ++shift) {
    for (int i = 0; i < kRays; ++i) {
      // The energy within a radius of r half widths is 1 - exp(-2 r^2).
      const double energy = (i + (shift + 0.5) / kShifts) / kRays;
      const double radius = std::sqrt(-0.5 * std::log(1.0 - energy));
      spirals_[static_cast<std::size_t>(shift)][static_cast<std::size_t>(i)] =
          radius * Eigen::Vector2d(std::cos(i * kGoldenAngle), std::sin(i * kGoldenAngle));
    }
  }
}

HeadRay LidarFootprint::ray(const FiringPattern::Beam& beam, const Eigen::Vector2d& place) const {
  const Eigen::Vector2d shift_m = place.cwiseProduct(half_exit_m_);
  const Eigen::Vector2d tilt = place.cwiseProduct(half_divergence_rad_);
  return {beam.origin_in_head + shift_m.x() * beam.side_in_head + shift_m.y() * beam.up_in_head,
          (beam.direction_in_head + tilt.x() * beam.side_in_head + tilt.y() * beam.up_in_head).normalized()};
}

LidarFootprint::Places LidarFootprint::places(double draw) const {
  const double shift = std::floor(draw * kShifts);
  const double turn = draw * kShifts - shift;
  Places places = spirals_[static_cast<std::size_t>(shift)];
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(2.0 * std::numbers::pi * turn).toRotationMatrix();
  for (Eigen::Vector2d& place : places) place = rotation * place;
  return places;
}

}  // namespace plumbline
