#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/scene_library.h"
#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/road_line.h"
#include "sim/scenes/scenery.h"

namespace plumbline {

/// What outdoor scenes are made of before they are handed over.
struct Outdoors {
  Scenery scenery;
  MjcfWriter geoms;  ///< of movers; holds the lamps
  std::vector<Route> routes;
  std::vector<Mover> movers;
};

/// Every outdoor scene's parameter: 0 by day, 1 at night, when its lamps shine.
SceneParameter night_parameter();

/// The whole scene in daylight, its sun 25 to 60 degrees high anywhere in the sky (30,000 to 60,000 lux) under a sky
/// that is as bright everywhere; or at night, lit by its lamps and a little of the sky's glow.
SceneDescription finish_outdoors(const std::string& name, Outdoors outdoors, bool night, std::uint64_t world_seed);

/// Land far from a line, in cells of 40 m: it begins 5 m below the ground beside the line, is reached where that ends
/// (half_width_m off), and rises to hills with woods at its horizon.
/// @param sunk  how much deeper it lies beside the line at s (under bridges)
void add_far_land(Scenery& scenery, const RoadLine& line, double half_width_m, std::uint64_t seed,
                  const std::function<double(double s)>& sunk);

/// Ground over a rectangle in square cells, solid down to 3 m below its lowest place.
struct Terrain {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  double cell_m = 2.0;
  std::function<double(double x, double y)> height;
  std::function<std::string(double x, double y)> material;  ///< at a cell's middle; empty: a hole
};
void add_ground(Scenery& scenery, const Terrain& ground);

/// Height of a Terrain as laid: on its triangles.
double height_on(const Terrain& ground, double x, double y);

}  // namespace plumbline
