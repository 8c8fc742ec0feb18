#pragma once

#include <string>

#include "sim/scenes/mjcf_writer.h"

namespace plumbline {

/// A straight flight of steps going up along x from the origin, `width_m` wide to both sides of y = 0 together. The
/// last riser leads to the floor above, whose edge is at x = run_m().
struct Flight {
  int risers = 8;
  double rise_m = 1.4;  ///< of the whole flight
  double tread_m = 0.27;
  double width_m = 1.0;

  double riser_m() const { return rise_m / risers; }
  double run_m() const { return tread_m * (risers - 1); }
};

/// The least number of equal risers, a multiple of `multiple`, of at most 0.18 m.
int riser_count(double rise_m, int multiple);

/// Steps 0.2 m thick, to be seen from below, with a handrail at the sides asked for.
void add_flight(MjcfWriter& writer, const std::string& material, const Flight& flight, const Pose& world_from_flight,
                bool left_rail, bool right_rail);

/// A rail on posts, 0.95 m high, along a straight line on a floor.
void add_rail(MjcfWriter& writer, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              const Pose& world_from_local = {});

}  // namespace plumbline
