#include "sim/vehicles/flight_reference.h"

#include <algorithm>
#include <cmath>

#include "estimator/geometry/so3.h"
#include "sim/box_smoothing.h"
#include "sim/constants.h"
#include "sim/course.h"

namespace plumbline {
namespace {

// Snap, which the craft's torques must follow, is still smooth after so many box filters.
constexpr int kPasses = 6;

/// Central differences; zero at the ends, where everything rests.
template <typename Get>
std::vector<Eigen::Vector3d> derivative(std::size_t count, Get difference) {
  std::vector<Eigen::Vector3d> result(count, Eigen::Vector3d::Zero());
  for (std::size_t i = 1; i + 1 < count; ++i) result[i] = difference(i - 1, i + 1) / (2.0 * Course::kStep_s);
  return result;
}

Eigen::Quaterniond attitude_for(const Eigen::Vector3d& acceleration, double yaw) {
  const Eigen::Vector3d z = (acceleration + kGravity * Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d y = z.cross(Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0)).normalized();
  Eigen::Matrix3d r;
  r << y.cross(z), y, z;
  return Eigen::Quaterniond(r);
}

FlightState blend(const FlightState& a, const FlightState& b, double u) {
  const auto mix = [u](const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
    return Eigen::Vector3d((1.0 - u) * x + u * y);
  };
  return {mix(a.position, b.position),     mix(a.velocity, b.velocity), mix(a.acceleration, b.acceleration),
          a.attitude.slerp(u, b.attitude), mix(a.rate, b.rate),         mix(a.rate_change, b.rate_change)};
}

}  // namespace

FlightReference::FlightReference(const MotionConfig& config, const World& world) {
  constexpr double kRounding_m = 2.0;
  const Path path(points_of(config, world), kRounding_m);
  Course course = course_along(path, config, Turning::kInAir);
  const auto half = static_cast<std::ptrdiff_t>(config.smoothing_s / kPasses / Course::kStep_s / 2.0);
  // The ends are held as long as the smoothing reaches, so that the flight ends where its path does.
  const std::vector<Eigen::Vector3d> position = box_smoothed(std::move(course.position), half, kPasses);
  const std::vector<double> yaw = box_smoothed(std::move(course.yaw), half, kPasses);
  const double above_m = config.route.empty() ? 0.0 : config.height_m;

  const std::size_t count = position.size();
  states_.resize(count);
  const auto velocity = derivative(count, [&](std::size_t a, std::size_t b) { return position[b] - position[a]; });
  for (std::size_t i = 0; i < count; ++i) {
    FlightState& state = states_[i];
    state.position = position[i] + above_m * Eigen::Vector3d::UnitZ();
    state.velocity = velocity[i];
    if (i > 0 && i + 1 < count) {
      state.acceleration =
          (position[i + 1] - 2.0 * position[i] + position[i - 1]) / (Course::kStep_s * Course::kStep_s);
    }
    state.attitude = attitude_for(state.acceleration, yaw[i]);
  }
  const auto rate = derivative(count, [&](std::size_t a, std::size_t b) {
    return log_so3(states_[a].attitude.conjugate() * states_[b].attitude);
  });
  const auto rate_change = derivative(count, [&](std::size_t a, std::size_t b) { return rate[b] - rate[a]; });
  for (std::size_t i = 0; i < count; ++i) {
    states_[i].rate = rate[i];
    states_[i].rate_change = rate_change[i];
  }
}

double FlightReference::duration_s() const { return static_cast<double>(states_.size() - 1) * Course::kStep_s; }

FlightState FlightReference::at(double time_s) const {
  const double place = std::clamp(time_s / Course::kStep_s, 0.0, static_cast<double>(states_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), states_.size() - 2);
  return blend(states_[i], states_[i + 1], place - static_cast<double>(i));
}

Trajectory FlightReference::trajectory() const {
  std::vector<PoseTrack::Stamped> poses;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    poses.push_back({static_cast<std::int64_t>(i) * static_cast<std::int64_t>(Course::kStep_s * 1e9),
                     {states_[i].attitude, states_[i].position}});
  }
  return Trajectory(poses);
}

}  // namespace plumbline
