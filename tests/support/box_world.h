#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "estimator/messages.h"
#include "sim/random_stream.h"

namespace plumbline::testing {

inline constexpr double kRangeSigma = 0.012;  ///< of the scans below, unless a test is about it [m]

/// An axis-aligned box. A hollow one is a room: rays stop at its far side.
struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  Eigen::Vector3d high = Eigen::Vector3d::Zero();
  bool hollow = false;
};

/// An upright cylinder without end.
struct Trunk {
  Eigen::Vector2d axis = Eigen::Vector2d::Zero();
  double radius_m = 0.2;
};

/// A world whose ray casting and distances are closed forms, so that a test needs no simulator to know the truth.
struct BoxWorld {
  std::vector<Box> boxes;
  std::vector<Trunk> trunks;
  double tube_radius_m = 0.0;  ///< a cylinder around the x axis, where above zero

  /// Distance along a unit ray to the first surface; infinite where there is none.
  double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  /// Distance of a point to the nearest surface.
  double distance(const Eigen::Vector3d& point) const;
};

/// A bare tunnel along x, 4.5 m wide and 3 m high, longer than the lidar sees.
BoxWorld smooth_tunnel();
/// A tunnel of the same width with a pair of door frames, 12 cm deep, every `spacing_m`.
BoxWorld framed_corridor(double spacing_m);
/// A room of 12 x 9 x 3.2 m with furniture and pillars.
BoxWorld furnished_room();
/// A hall along x, 14 m wide, with pillars and crates at irregular places, for a drive of `length_m`.
BoxWorld pillared_hall(double length_m);

/// Level ground with a row of trunks of 10 to 20 cm radius on either side of the x axis, for a drive of `length_m`.
BoxWorld avenue(double length_m);

/// Level ground and, on either side of the x axis, plates of a leaf spray's size in clumps: no edge, no plane, no
/// trunk.
BoxWorld thicket(double length_m);

/// A motion as the true world_from_body over time [s].
using Motion = std::function<Pose(double time_s)>;

/// VLP-16 pattern: 16 rings 2 degrees apart, 1808 firings a revolution, 10 Hz, every return from where the lidar is
/// then.
LidarScan vlp16_scan(const BoxWorld& world, const Motion& motion, std::int64_t stamp_ns, const Pose& body_from_lidar,
                     double range_sigma_m, RandomStream& noise);

/// A line scanner of 180 degrees in steps of half a degree, turned about its forward axis by half a turn in 1 s, back
/// and forth: the sweep of that number, in ten parts of four lines.
std::vector<LidarScan> turned_scanner_sweep(const BoxWorld& world, const Motion& motion, std::int64_t sweep,
                                            double range_sigma_m, RandomStream& noise);

}  // namespace plumbline::testing
