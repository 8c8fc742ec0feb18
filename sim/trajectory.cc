#include "sim/trajectory.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace plumbline {
namespace {

using Channels = Eigen::Matrix<double, 7, 1>;

Channels channels_of(const Pose& pose, const Channels* previous) {
  Channels c;
  c << pose.translation, pose.rotation.coeffs();
  // q and -q are one rotation; the spline needs neighbours on the same side.
  if (previous != nullptr && previous->tail<4>().dot(c.tail<4>()) < 0.0) c.tail<4>() *= -1.0;
  return c;
}

/// Second derivatives of the natural cubic spline: the usual tridiagonal system, by the Thomas algorithm.
std::vector<Channels> natural_second_derivatives(const std::vector<double>& t, const std::vector<Channels>& y) {
  const std::size_t n = t.size();
  std::vector<Channels> second(n, Channels::Zero());
  std::vector<double> upper(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = t[i] - t[i - 1];
    const double after = t[i + 1] - t[i];
    const Channels slope_change = (y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before;
    const double pivot = 2.0 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    second[i] = (6.0 * slope_change - before * second[i - 1]) / pivot;
  }
  for (std::size_t i = n - 1; i-- > 1;) second[i] -= upper[i] * second[i + 1];
  return second;
}

/// 2 vec(conj(a) b): the vector part that turns quaternion derivatives into rates.
Eigen::Vector3d twice_vector_part(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return 2.0 * (a.conjugate() * b).vec();
}

}  // namespace

Trajectory::Trajectory(const std::vector<PoseTrack::Stamped>& poses) {
  if (poses.size() < 4) throw std::invalid_argument("trajectory: at least 4 poses are needed");
  for (const auto& stamped : poses) {
    const double t = static_cast<double>(stamped.stamp_ns) * 1e-9;
    if (!times_s_.empty() && t <= times_s_.back()) throw std::invalid_argument("trajectory: stamps must increase");
    times_s_.push_back(t);
    values_.push_back(channels_of(stamped.pose, values_.empty() ? nullptr : &values_.back()));
  }
  start_ns_ = poses.front().stamp_ns;
  end_ns_ = poses.back().stamp_ns;
  second_ = natural_second_derivatives(times_s_, values_);
}

Trajectory::Trajectory(const Pose& first, std::int64_t start_ns, std::int64_t step_ns)
    : start_ns_(start_ns - 2 * step_ns), end_ns_(start_ns_ - step_ns), step_ns_(step_ns) {
  if (step_ns <= 0) throw std::invalid_argument("trajectory: the step must be above 0");
  const Channels rest = channels_of(first, nullptr);
  controls_[0] = controls_[1] = rest;
  for (int knot = 0; knot < 2; ++knot) push_knot(rest, rest, rest);
}

void Trajectory::extend(const Pose& control) {
  const Channels next = channels_of(control, &controls_[1]);
  push_knot(controls_[0], controls_[1], next);
  controls_[0] = controls_[1];
  controls_[1] = next;
}

/// A B-spline's value and second derivative at a knot, from the control poses around it.
void Trajectory::push_knot(const Channels& before, const Channels& at, const Channels& after) {
  end_ns_ += step_ns_;
  const double step_s = static_cast<double>(step_ns_) * 1e-9;
  times_s_.push_back(static_cast<double>(end_ns_) * 1e-9);
  values_.push_back((before + 4.0 * at + after) / 6.0);
  second_.push_back((before - 2.0 * at + after) / (step_s * step_s));
}

std::int64_t Trajectory::knot_ns() const {
  constexpr std::int64_t kMillisecond_ns = 1'000'000;
  const auto legs = static_cast<std::int64_t>(times_s_.size()) - 1;
  const std::int64_t mean_ns = (end_ns_ - start_ns_) / legs;
  return std::max<std::int64_t>((mean_ns + kMillisecond_ns / 2) / kMillisecond_ns, 1) * kMillisecond_ns;
}

double Trajectory::knot_after_s(double time_s) const {
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
  return after == times_s_.end() ? std::numeric_limits<double>::infinity() : *after;
}

MotionState Trajectory::at_seconds(double time_s) const {
  const bool resting = time_s <= times_s_.front() || time_s >= times_s_.back();
  const double t = std::clamp(time_s, times_s_.front(), times_s_.back());
  const auto after = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, t);
  const auto i = static_cast<std::size_t>(after - times_s_.begin());
  const double h = times_s_[i] - times_s_[i - 1];
  const double b = (t - times_s_[i - 1]) / h;
  const double a = 1.0 - b;
  const Channels value = a * values_[i - 1] + b * values_[i] +
                         (h * h / 6.0) * ((a * a * a - a) * second_[i - 1] + (b * b * b - b) * second_[i]);
  MotionState state;
  const Eigen::Vector4d c = value.tail<4>();
  const double norm = c.norm();
  const Eigen::Vector4d unit = c / norm;
  const Eigen::Quaterniond q(unit[3], unit[0], unit[1], unit[2]);
  state.world_from_body = {q, value.head<3>()};
  if (resting) return state;

  const Channels first = (values_[i] - values_[i - 1]) / h +
                         (h / 6.0) * ((1.0 - 3.0 * a * a) * second_[i - 1] + (3.0 * b * b - 1.0) * second_[i]);
  const Channels second = a * second_[i - 1] + b * second_[i];
  state.velocity_in_world = first.head<3>();
  state.acceleration_in_world = second.head<3>();
  // Derivatives of c / |c|; only what is orthogonal to q turns, so the norm's own second derivative drops out.
  const Eigen::Vector4d dc = first.tail<4>();
  const double dnorm = unit.dot(dc);
  const Eigen::Vector4d dq = (dc - unit * dnorm) / norm;
  const Eigen::Vector4d ddq = (second.tail<4>() - 2.0 * dq * dnorm) / norm;
  state.angular_rate_in_body = twice_vector_part(q, Eigen::Quaterniond(dq[3], dq[0], dq[1], dq[2]));
  state.angular_acceleration_in_body = twice_vector_part(q, Eigen::Quaterniond(ddq[3], ddq[0], ddq[1], ddq[2]));
  return state;
}

}  // namespace plumbline
