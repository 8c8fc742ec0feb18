#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimator/lidar/deskew.h"
#include "estimator/messages.h"

namespace plumbline {

/// A scan's usable returns sorted by ring, in firing order within a ring, cut into runs without a gap, with running
/// sums from which the mean over any window costs the same. All indices are positions in the table.
class RingTable {
 public:
  RingTable(const LidarScan& scan, const DeskewedScan& deskewed, const Calibration& calibration);

  int size() const { return static_cast<int>(entries_.size()); }
  int ring_count() const { return static_cast<int>(begin_.size()) - 1; }
  int ring_begin(int ring) const { return begin_[static_cast<std::size_t>(ring)]; }
  int ring_end(int ring) const { return begin_[static_cast<std::size_t>(ring) + 1]; }
  /// Angle between neighbouring beams of a ring [rad], the median.
  float beam_spacing(int ring) const { return rings_[static_cast<std::size_t>(ring)].spacing; }
  /// True of a line scanner turned by a motor: its rings are lines that follow each other in time.
  bool lines_in_turn() const { return lines_in_turn_; }
  /// False where all returns bear one time, as in recordings that were motion-compensated.
  bool timed() const { return timed_; }
  /// Least angle between rings across which normals are read [rad]; across closer ones range noise would tilt them.
  static constexpr float kCrossAngle = 0.025F;
  /// The nearest ring at least kCrossAngle above (direction 1) or below (-1), or -1. Of lines in turn the next one.
  int ring_across(int ring, int direction) const;

  const Eigen::Vector3f& position(int i) const { return entry(i).position; }
  /// Of the beam, unit, in B, from where the lidar stood when it measured the return.
  const Eigen::Vector3f& beam(int i) const { return entry(i).beam; }
  /// Of the beam, unit, in L at its own time.
  const Eigen::Vector3f& direction(int i) const { return entry(i).direction; }
  float range(int i) const { return entry(i).range; }
  float intensity(int i) const { return entry(i).intensity; }
  std::int32_t offset_ns(int i) const { return entry(i).offset_ns; }
  /// The run of returns on one visible surface or chain of surfaces around i, [run_begin, run_end).
  int run_begin(int i) const { return entry(i).run_begin; }
  int run_end(int i) const { return entry(i).run_end; }
  /// True where neighbours i and j of one ring are next to each other in angle, though perhaps not in depth.
  bool adjacent_in_angle(int i, int j) const;

  /// Mean position over [first, last].
  Eigen::Vector3f mean(int first, int last) const {
    const Eigen::Vector3d sum = sums_[static_cast<std::size_t>(last) + 1] - sums_[static_cast<std::size_t>(first)];
    return (sum / (last - first + 1)).cast<float>();
  }

 private:
  struct Entry {
    Eigen::Vector3f position;   // de-skewed, in B
    Eigen::Vector3f beam;       // of the beam, in B
    Eigen::Vector3f direction;  // of the beam, in L at its own time
    float range = 0.0F;         // as measured
    float intensity = 0.0F;
    std::int32_t offset_ns = 0;
    int run_begin = 0;
    int run_end = 0;
  };
  struct Ring {
    float spacing = 0.0F;
    float elevation = 0.0F;
  };

  const Entry& entry(int i) const { return entries_[static_cast<std::size_t>(i)]; }
  void sort_by_ring(const LidarScan& scan, const DeskewedScan& deskewed, const Calibration& calibration);
  void measure_rings();
  bool follow_each_other() const;
  void cut_runs();
  bool on_one_surface(int i, int j, float spacing) const;

  std::vector<Entry> entries_;
  std::vector<int> begin_;
  std::vector<Ring> rings_;
  bool lines_in_turn_ = false;
  bool timed_ = false;
  std::vector<Eigen::Vector3d> sums_;  // sums_[i] is the sum over [0, i)
};

}  // namespace plumbline
