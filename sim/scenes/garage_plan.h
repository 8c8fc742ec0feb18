#pragma once

#include <cstdint>
#include <vector>

#include "sim/scene_library.h"

namespace plumbline {

/// The garage's measures; see garage.h for the lanes.
struct GaragePlan {
  static constexpr double kWallM = 0.2;
  static constexpr double kLaneY = 4.75;
  static constexpr double kIslandHalfM = 2.5;
  static constexpr double kIslandInsetM = 6.5;  ///< from the end walls: a cross lane's width
  static constexpr double kBayDepthM = 5.0;
  static constexpr double kBayPitchM = 2.8;
  static constexpr double kKerbM = 0.12;
  static constexpr double kDoorWidthM = 3.0;
  static constexpr double kDoorHeightM = 2.5;
  static constexpr double kBeamDepthM = 0.35;

  int halls = 3;
  double length = 36.0;
  double width = 24.0;
  double ceiling = 3.4;
  double clutter = 0.5;
  double pillar_spacing = 7.0;
  std::uint64_t seed = 0;

  GaragePlan(const SceneValues& values, std::uint64_t world_seed);

  double half_width() const { return width / 2.0; }
  double west_of(int hall) const { return hall * (length + kWallM); }
  double bay_front() const { return half_width() - kBayDepthM; }  ///< |y|
  double door_y(int hall) const { return hall % 2 == 0 ? -kLaneY : kLaneY; }
  bool is_last(int hall) const { return hall == halls - 1; }

  /// x of the pillar rows, from the hall's western wall.
  std::vector<double> pillar_rows() const;
};

}  // namespace plumbline
