#include "sim/vehicles/tyre.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace plumbline {

std::optional<Contact> contact_of(const TyreDesign& tyre, const WheelMotion& wheel, Ground& ground, double route_z) {
  constexpr int kSide = 3;            // looked at ahead and behind
  constexpr double kSpacing = 0.22;   // of the radius
  constexpr double kHalfWidth = 0.3;  // of the radius
  const Eigen::Vector3d& c = wheel.centre;
  const Eigen::Vector2d left = wheel.axle.head<2>().normalized();
  const Eigen::Vector2d forward(left.y(), -left.x());
  const double step_m = kSpacing * tyre.radius_m;
  std::array<double, 2 * kSide + 1> depth{};
  int deepest = 0;
  for (int i = 0; i <= 2 * kSide; ++i) {
    const double ahead = (i - kSide) * step_m;
    const Eigen::Vector2d place = c.head<2>() + ahead * forward;
    const auto k = static_cast<std::size_t>(i);
    depth[k] =
        ground.height(place.x(), place.y(), route_z) + std::sqrt(tyre.radius_m * tyre.radius_m - ahead * ahead) - c.z();
    if (depth[k] > depth[static_cast<std::size_t>(deepest)]) deepest = i;
  }
  Contact contact;
  contact.depth_m = depth[static_cast<std::size_t>(deepest)];
  double ahead = (deepest - kSide) * step_m;
  if (deepest > 0 && deepest < 2 * kSide) {  // the top of the parabola through the neighbours
    const double before = depth[static_cast<std::size_t>(deepest) - 1];
    const double after = depth[static_cast<std::size_t>(deepest) + 1];
    const double bend = before - 2.0 * contact.depth_m + after;
    if (bend < 0.0) {
      const double shift = 0.5 * (before - after) / bend;
      ahead += shift * step_m;
      contact.depth_m -= 0.25 * (before - after) * shift;
    }
  }
  if (contact.depth_m <= 0.0) return std::nullopt;
  const double half_m = kHalfWidth * tyre.radius_m;
  const Eigen::Vector2d side = half_m * left;
  const double bank = (ground.height(c.x() + side.x(), c.y() + side.y(), route_z) -
                       ground.height(c.x() - side.x(), c.y() - side.y(), route_z)) /
                      (2.0 * half_m);
  const double up = std::sqrt(std::max(tyre.radius_m * tyre.radius_m - ahead * ahead, 1e-12));
  contact.normal.head<2>() = -ahead / up * forward - bank * left;
  contact.normal.z() = 1.0;
  contact.normal.normalize();
  return contact;
}

TyreForce Tyre::step(const WheelMotion& wheel, Ground& ground, double route_z, double dt_s) {
  constexpr double kSlipDamping = 0.02;  // [s] of the slip stiffness; keeps a standing wheel from swinging
  const std::optional<Contact> contact = contact_of(design_, wheel, ground, route_z);
  if (!contact) {
    deflection_.setZero();
    return {};
  }
  const Eigen::Vector3d& normal = contact->normal;
  const Eigen::Vector3d forward = wheel.axle.cross(normal).normalized();
  const Eigen::Vector3d left = normal.cross(forward);
  TyreForce result;
  result.load_n =
      std::max(0.0, (design_.stiffness * contact->depth_m - design_.damping * wheel.velocity.dot(normal)) * normal.z());

  const double rolling_mps = wheel.velocity.dot(forward);
  const double radius_m = design_.radius_m - contact->depth_m;
  const Eigen::Vector2d slip_mps(rolling_mps - wheel.spin_rad_s * radius_m, wheel.velocity.dot(left));
  const double decay = std::abs(rolling_mps) / design_.relaxation_m;
  deflection_ = (deflection_ + dt_s * slip_mps) / (1.0 + dt_s * decay);
  const double stiffness = design_.slip_stiffness * result.load_n / design_.relaxation_m;
  const double damping = kSlipDamping * stiffness / (1.0 + decay * kSlipDamping * 10.0);
  Eigen::Vector2d grip = -stiffness * deflection_ - damping * (slip_mps - decay * deflection_);
  if (design_.castor) grip.y() = deflection_.y() = 0.0;
  const double most = design_.friction * result.load_n;
  if (grip.norm() > most) {
    grip *= most / grip.norm();
    if (stiffness > 0.0) deflection_ = -grip / stiffness;
  }
  result.force = result.load_n * normal + grip.x() * forward + grip.y() * left;
  result.torque = (-radius_m * normal).cross(result.force);
  result.torque -= rolling_resistance(wheel.spin_rad_s, result.load_n, dt_s) * wheel.axle;
  return result;
}

/// Dry friction holds a wheel that stands: it twists by kHeld_rad at most, as a spring with a damper, and then rolls.
double Tyre::rolling_resistance(double spin_rad_s, double load_n, double dt_s) {
  constexpr double kHeld_rad = 0.02;
  constexpr double kDamping_s = 0.1;
  twist_rad_ = std::clamp(twist_rad_ + dt_s * spin_rad_s, -kHeld_rad, kHeld_rad);
  const double share = std::clamp((twist_rad_ + kDamping_s * spin_rad_s) / kHeld_rad, -1.0, 1.0);
  return share * design_.rolling_resistance * load_n * design_.radius_m;
}

}  // namespace plumbline
