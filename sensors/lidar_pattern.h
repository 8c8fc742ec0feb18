#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sensors/lidar_model.h"

namespace plumbline {

/// When and where to a lidar fires. The lasers that share an attitude of the head form a cycle: all of a Velodyne's
/// firing cycle or an Ouster's column, one step of a line scanner. Times are in picoseconds, in which the data sheets'
/// figures are whole: a message has no rounding of its own.
class FiringPattern {
 public:
  /// A laser's ray in the head's frame at the start of the cycle; what the head turns until it fires is included.
  struct Beam {
    Eigen::Vector3d origin_in_head;
    Eigen::Vector3d direction_in_head;
    Eigen::Vector3d side_in_head;  ///< unit, square to the beam and to the head's axis
    Eigen::Vector3d up_in_head;    ///< unit, square to both
    double share_of_cycle = 0.0;   ///< of the cycle's time at which it fires
    std::int64_t offset_ps = 0;    ///< within the cycle
    std::uint16_t ring = 0;
    int above = -1;  ///< index of the beam next above, or -1
    int below = -1;
  };

  struct Cycle {
    std::int64_t offset_ps = 0;  ///< of its start since the message's start; negative if the message before began it
    Eigen::Matrix3d lidar_from_head;
    Eigen::Matrix3d reported_lidar_from_head;  ///< as the encoder reads it
    std::uint16_t first_ring = 0;              ///< to add to the beam's
  };

  /// @throws std::invalid_argument as validate_or_throw
  explicit FiringPattern(const LidarModel& model);

  const std::vector<Beam>& beams() const { return beams_; }
  std::int64_t cycle_ps() const { return cycle_ps_; }
  std::int64_t message_ps() const { return message_ps_; }

  /// The cycles that may fire within a message, in time order. A beam fires in the message if
  /// 0 <= cycle.offset_ps + beam.offset_ps < message_ps(). The device's clock counts from message 0.
  /// @param read_exactly  the encoder's resolution is left out
  std::vector<Cycle> cycles(std::int64_t message, bool read_exactly) const;

 private:
  void add_beams();
  void find_neighbours();
  std::vector<Cycle> spinning_cycles(std::int64_t message, bool read_exactly) const;
  std::vector<Cycle> column_cycles(const ColumnHead& head, bool read_exactly) const;
  std::vector<Cycle> line_cycles(const TwoAxisHead& head, std::int64_t message, bool read_exactly) const;

  LidarModel model_;
  std::vector<Beam> beams_;
  std::int64_t cycle_ps_ = 0;
  std::int64_t message_ps_ = 0;
};

}  // namespace plumbline
