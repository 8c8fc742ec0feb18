#include "estimator/lidar/ring_table.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

// A larger range step between neighbouring beams is a gap along the beam. A surface 10 degrees from grazing steps by
// cot(10 deg) = 5.7 beam spacings; the constant is many times a lidar's range noise.
constexpr float kGapConstant_m = 0.1F;
constexpr float kGapSlope = 5.7F;
// Beams further apart than this many spacings have lost the returns between them.
constexpr float kMissingBeams = 3.0F;

}  // namespace

RingTable::RingTable(const LidarScan& scan, const DeskewedScan& deskewed, const Calibration& calibration) {
  sort_by_ring(scan, deskewed, calibration);
  measure_rings();
  lines_in_turn_ = follow_each_other();
  timed_ = std::any_of(entries_.begin(), entries_.end(),
                       [&](const Entry& e) { return e.offset_ns != entries_.front().offset_ns; });
  cut_runs();
  sums_.reserve(entries_.size() + 1);
  sums_.emplace_back(Eigen::Vector3d::Zero());
  for (const Entry& e : entries_) sums_.emplace_back(sums_.back() + e.position.cast<double>());
}

void RingTable::sort_by_ring(const LidarScan& scan, const DeskewedScan& deskewed, const Calibration& calibration) {
  const auto ring_count = static_cast<std::size_t>(std::max(1, calibration.lidar_rings));
  const std::size_t count = std::min(scan.points.size(), deskewed.points.size());
  std::vector<float> ranges(count, -1.0F);
  begin_.assign(ring_count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    const float range = scan.points[i].position.norm();
    const bool usable = range >= static_cast<float>(calibration.lidar_min_range_m) &&
                        range <= static_cast<float>(calibration.lidar_max_range_m) &&
                        scan.points[i].ring < ring_count && deskewed.points[i].allFinite();
    if (!usable) continue;
    ranges[i] = range;
    ++begin_[scan.points[i].ring + 1U];
  }
  for (std::size_t r = 0; r < ring_count; ++r) begin_[r + 1] += begin_[r];
  entries_.resize(static_cast<std::size_t>(begin_.back()));
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < count; ++i) {
    if (ranges[i] < 0.0F) continue;
    const LidarPoint& point = scan.points[i];
    Entry& e = entries_[static_cast<std::size_t>(next[point.ring]++)];
    e.position = deskewed.points[i];
    e.beam = (e.position - deskewed.origin(point.offset_ns)).normalized();
    e.direction = point.position / ranges[i];
    e.range = ranges[i];
    e.intensity = point.intensity;
    e.offset_ns = point.offset_ns;
  }
}

void RingTable::measure_rings() {
  rings_.resize(begin_.size() - 1);
  std::vector<float> steps;
  for (int r = 0; r < ring_count(); ++r) {
    steps.clear();
    float height = 0.0F;
    for (int i = ring_begin(r); i < ring_end(r); ++i) {
      height += entry(i).direction.z();
      if (i > ring_begin(r)) steps.push_back((entry(i).direction - entry(i - 1).direction).norm());
    }
    if (steps.empty()) continue;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    const float mean_height = height / static_cast<float>(ring_end(r) - ring_begin(r));
    rings_[static_cast<std::size_t>(r)] = {*middle, std::asin(std::clamp(mean_height, -1.0F, 1.0F))};
  }
}

/// Rings that fire together overlap in time, lines in turn do not; of a single ring nothing can be said.
bool RingTable::follow_each_other() const {
  int filled = 0;
  std::int32_t last_ns = 0;
  for (int r = 0; r < ring_count(); ++r) {
    if (ring_begin(r) == ring_end(r)) continue;
    if (filled++ > 0 && offset_ns(ring_begin(r)) <= last_ns) return false;
    last_ns = offset_ns(ring_end(r) - 1);
  }
  return filled > 1;
}

int RingTable::ring_across(int ring, int direction) const {
  const float elevation = rings_[static_cast<std::size_t>(ring)].elevation;
  for (int r = ring + direction; r >= 0 && r < ring_count(); r += direction) {
    const bool filled = ring_end(r) > ring_begin(r);
    if (filled && lines_in_turn_) return r;
    if (filled && std::abs(rings_[static_cast<std::size_t>(r)].elevation - elevation) >= kCrossAngle) return r;
  }
  return -1;
}

bool RingTable::adjacent_in_angle(int i, int j) const {
  const auto above = std::upper_bound(begin_.begin(), begin_.end(), i);
  const float spacing = beam_spacing(static_cast<int>(above - begin_.begin()) - 1);
  return (entry(i).direction - entry(j).direction).norm() <= kMissingBeams * spacing;
}

bool RingTable::on_one_surface(int i, int j, float spacing) const {
  if ((entry(i).direction - entry(j).direction).norm() > kMissingBeams * spacing) return false;
  const float nearer = std::min(range(i), range(j));
  return std::abs(range(i) - range(j)) <= kGapConstant_m + kGapSlope * spacing * nearer;
}

void RingTable::cut_runs() {
  for (int r = 0; r < ring_count(); ++r) {
    for (int first = ring_begin(r); first < ring_end(r);) {
      int end = first + 1;
      while (end < ring_end(r) && on_one_surface(end - 1, end, beam_spacing(r))) ++end;
      for (int i = first; i < end; ++i) {
        entries_[static_cast<std::size_t>(i)].run_begin = first;
        entries_[static_cast<std::size_t>(i)].run_end = end;
      }
      first = end;
    }
  }
}

}  // namespace plumbline
