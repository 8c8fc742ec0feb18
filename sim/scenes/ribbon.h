#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/scenes/road_line.h"
#include "sim/scenes/scenery.h"

namespace plumbline {

/// A point of the ground across a road: to its left, and above the line.
struct Station {
  double n = 0.0;
  double up = 0.0;
};

/// The ground across a road at one s, from right to left.
struct Section {
  std::vector<Station> stations;
  std::vector<std::string> materials;  ///< of the strips between the stations; empty: a hole

  /// Height of the ground above the line.
  double up_at(double n) const;
};

/// As many stations at every s.
using SectionAt = std::function<Section(double s)>;

/// Lays the ground along a line, one row of quads every step_m.
void add_ribbon(Scenery& scenery, const RoadLine& line, const SectionAt& section_at, double from_s, double to_s,
                double step_m);

/// Smooth noise in [-1, 1] with one random value for every unit of x and y.
double smooth_noise(std::uint64_t seed, double x, double y);

}  // namespace plumbline
