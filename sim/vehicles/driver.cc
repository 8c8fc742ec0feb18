#include "sim/vehicles/driver.h"

#include <algorithm>
#include <cmath>

#include "sim/constants.h"

namespace plumbline {
namespace {

constexpr double kLookAhead_s = 0.2;  // the steering's and the tyres' delay
constexpr double kPlaceGain_hz = 0.8;
constexpr double kSpeedGain_hz = 2.0;

/// Place, speed and acceleration of a timetable at any time.
struct Timed {
  double along_m = 0.0;
  double speed_mps = 0.0;
  double acceleration_mps2 = 0.0;
};

Timed timed(const std::vector<double>& along_m, double time_s) {
  constexpr double h = Course::kStep_s;
  const auto last = static_cast<std::ptrdiff_t>(along_m.size()) - 1;
  const double place = std::clamp(time_s / h, 0.0, static_cast<double>(last));
  const auto i = std::min(static_cast<std::ptrdiff_t>(place), last - 1);
  const double u = place - static_cast<double>(i);
  const auto at = [&](std::ptrdiff_t k) {
    return along_m[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, last))];
  };
  const auto blend = [u](double a, double b) { return (1.0 - u) * a + u * b; };
  const auto slope = [&](std::ptrdiff_t k) { return (at(k + 1) - at(k - 1)) / (2.0 * h); };
  const auto bend = [&](std::ptrdiff_t k) { return (at(k + 1) - 2.0 * at(k) + at(k - 1)) / (h * h); };
  return {blend(at(i), at(i + 1)), blend(slope(i), slope(i + 1)), blend(bend(i), bend(i + 1))};
}

}  // namespace

DriverCommand Driver::decide(double time_s, const DriverView& view) {
  along_m_ = path_.nearest(view.rear_axle, along_m_);
  const PathPoint here = path_.at(along_m_);
  const Eigen::Vector2d left(-std::sin(here.heading()), std::cos(here.heading()));
  off_path_m_ = left.dot((view.rear_axle - here.position).head<2>());
  const double off_heading = std::remainder(view.heading - here.heading(), 2.0 * M_PI);

  const double speed = std::max(view.speed_mps, 0.3);
  // Back to the path within a certain time, but over no less than the vehicle's own length.
  const double rate = std::min(design_.tracking_rad_s / speed, 1.0 / design_.wheelbase_m);
  const double ahead = path_.at(along_m_ + kLookAhead_s * view.speed_mps).turn();
  DriverCommand command;
  command.turn = ahead - rate * rate * off_path_m_ - 1.8 * rate * std::sin(off_heading);
  const double tightest = 1.0 / design_.least_radius_m;
  command.turn = std::clamp(command.turn, -tightest, tightest);

  const Timed wanted = timed(course_.along_m, time_s);
  const double wanted_mps = wanted.speed_mps + kPlaceGain_hz * (wanted.along_m - along_m_);
  command.acceleration_mps2 =
      wanted.acceleration_mps2 + kSpeedGain_hz * (wanted_mps - view.speed_mps) + kGravity * here.tangent.z();
  return command;
}

}  // namespace plumbline
