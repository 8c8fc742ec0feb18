#include "sensors/lidar_pattern.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "sim/constants.h"

namespace plumbline {
namespace {

constexpr double kPi = std::numbers::pi;

std::int64_t picoseconds(double seconds) { return std::llround(seconds * 1e12); }

Eigen::Matrix3d about_z(double angle) { return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix(); }
Eigen::Matrix3d about_x(double angle) { return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()).matrix(); }

double quantised(double value, double step) { return step > 0.0 ? step * std::round(value / step) : value; }

// Spinning heads turn clockwise seen from above, a message from straight behind to straight behind.
double head_azimuth(double share_of_turn) { return kPi * (1.0 - 2.0 * share_of_turn); }

/// Beam indices from the lowest to the highest.
std::vector<int> by_elevation(const std::vector<LidarBeam>& beams) {
  std::vector<int> order(beams.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return beams[static_cast<std::size_t>(a)].elevation_deg < beams[static_cast<std::size_t>(b)].elevation_deg;
  });
  return order;
}

/// Of a 2-axis head's joint, at a time since message 0.
double joint_angle_deg(const TwoAxisHead& head, double time_s) {
  const double half_turns = head.joint_deg_per_s * time_s / 180.0;
  if (head.continuous) return 360.0 * (0.5 * half_turns - std::floor(0.5 * half_turns)) - 90.0;
  const double into_round = 2.0 * (0.5 * half_turns - std::floor(0.5 * half_turns));  // 0 to 2: there and back
  return 180.0 * (into_round < 1.0 ? into_round : 2.0 - into_round) - 90.0;
}

}  // namespace

FiringPattern::FiringPattern(const LidarModel& model) : model_(model), message_ps_(1000 * message_period_ns(model)) {
  validate_or_throw(model_);
  if (const auto* spinning = std::get_if<SpinningHead>(&model_.head)) {
    cycle_ps_ = picoseconds(spinning->cycle_s);
  } else if (const auto* columns = std::get_if<ColumnHead>(&model_.head)) {
    cycle_ps_ = message_ps_ / columns->columns;
  } else {
    const auto& lines = std::get<TwoAxisHead>(model_.head);
    cycle_ps_ = picoseconds(1.0 / (lines.line_rate_hz * lines.steps_per_turn));
  }
  add_beams();
  find_neighbours();
}

void FiringPattern::add_beams() {
  const bool turns_meanwhile = std::holds_alternative<SpinningHead>(model_.head);
  const auto* columns = std::get_if<ColumnHead>(&model_.head);
  const double origin_radius_m = columns ? columns->beam_origin_m : 0.0;
  for (const LidarBeam& beam : model_.beams) {
    const std::int64_t offset_ps = picoseconds(beam.firing_s);
    const double turned =
        turns_meanwhile ? -2.0 * kPi * static_cast<double>(offset_ps) / static_cast<double>(message_ps_) : 0.0;
    const Eigen::Matrix3d rotation = about_z(turned + beam.azimuth_deg * kDegree) *
                                     Eigen::AngleAxisd(-beam.elevation_deg * kDegree, Eigen::Vector3d::UnitY());
    beams_.push_back({.origin_in_head = about_z(turned) * Eigen::Vector3d(origin_radius_m, 0, beam.vertical_offset_m),
                      .direction_in_head = rotation.col(0),
                      .side_in_head = rotation.col(1),
                      .up_in_head = rotation.col(2),
                      .share_of_cycle = static_cast<double>(offset_ps) / static_cast<double>(cycle_ps_),
                      .offset_ps = offset_ps});
  }
}

void FiringPattern::find_neighbours() {
  const std::vector<int> order = by_elevation(model_.beams);
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    Beam& beam = beams_[static_cast<std::size_t>(order[rank])];
    beam.ring = static_cast<std::uint16_t>(rank);
    if (rank > 0) beam.below = order[rank - 1];
    if (rank + 1 < order.size()) beam.above = order[rank + 1];
  }
}

std::vector<FiringPattern::Cycle> FiringPattern::cycles(std::int64_t message, bool read_exactly) const {
  if (const auto* columns = std::get_if<ColumnHead>(&model_.head)) return column_cycles(*columns, read_exactly);
  if (const auto* lines = std::get_if<TwoAxisHead>(&model_.head)) return line_cycles(*lines, message, read_exactly);
  return spinning_cycles(message, read_exactly);
}

std::vector<FiringPattern::Cycle> FiringPattern::spinning_cycles(std::int64_t message, bool read_exactly) const {
  const double resolution = read_exactly ? 0.0 : model_.encoder_resolution_deg * kDegree;
  std::vector<Cycle> cycles;
  cycles.reserve(static_cast<std::size_t>(message_ps_ / cycle_ps_) + 2);
  const std::int64_t into_cycle_ps = (message * (message_ps_ % cycle_ps_)) % cycle_ps_;
  for (std::int64_t offset_ps = -into_cycle_ps; offset_ps < message_ps_; offset_ps += cycle_ps_) {
    const double azimuth = head_azimuth(static_cast<double>(offset_ps) / static_cast<double>(message_ps_));
    cycles.push_back({offset_ps, about_z(azimuth), about_z(quantised(azimuth, resolution)), 0});
  }
  return cycles;
}

std::vector<FiringPattern::Cycle> FiringPattern::column_cycles(const ColumnHead& head, bool read_exactly) const {
  const double resolution = read_exactly ? 0.0 : model_.encoder_resolution_deg * kDegree;
  std::vector<Cycle> cycles;
  cycles.reserve(static_cast<std::size_t>(head.columns));
  for (int column = 0; column < head.columns; ++column) {
    const double azimuth = head_azimuth(static_cast<double>(column) / head.columns);
    const std::int64_t offset_ps = column * message_ps_ / head.columns;
    cycles.push_back({offset_ps, about_z(azimuth), about_z(quantised(azimuth, resolution)), 0});
  }
  return cycles;
}

std::vector<FiringPattern::Cycle> FiringPattern::line_cycles(const TwoAxisHead& head, std::int64_t message,
                                                             bool read_exactly) const {
  const double resolution_deg = read_exactly ? 0.0 : model_.encoder_resolution_deg;
  const auto lines = static_cast<int>(std::lround(head.line_rate_hz / model_.rate_hz));
  const int first_line = static_cast<int>(message % messages_per_sweep(model_)) * lines;
  const double line_ps = 1e12 / head.line_rate_hz;
  std::vector<Cycle> cycles;
  cycles.reserve(static_cast<std::size_t>(lines) * static_cast<std::size_t>(head.last_step - head.first_step + 1));
  for (int line = 0; line < lines; ++line) {
    for (int step = head.first_step; step <= head.last_step; ++step) {
      const std::int64_t offset_ps = std::llround(line_ps * (line + static_cast<double>(step) / head.steps_per_turn));
      const double time_s =
          1e-12 * (static_cast<double>(message) * static_cast<double>(message_ps_) + static_cast<double>(offset_ps));
      const double joint_deg = joint_angle_deg(head, time_s);
      const Eigen::Matrix3d scanner_from_head = about_z(2.0 * kPi * (step - head.front_step) / head.steps_per_turn);
      cycles.push_back({offset_ps, about_x(joint_deg * kDegree) * scanner_from_head,
                        about_x(quantised(joint_deg, resolution_deg) * kDegree) * scanner_from_head,
                        static_cast<std::uint16_t>(first_line + line)});
    }
  }
  return cycles;
}

}  // namespace plumbline
