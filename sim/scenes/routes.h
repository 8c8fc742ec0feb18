#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sim/world.h"

namespace plumbline {

/// A route along straight legs between corners, its turns rounded to at most `turn_radius_m`, with points every 0.5 to
/// 2.5 m (closer only at its end). A closed route leads from the last corner back to the first.
/// @param corners  at least two, neighbours apart
Route make_route(std::string name, const std::vector<Eigen::Vector3d>& corners, double turn_radius_m,
                 bool closed = false);

/// Once round a rectangle with its centre and half sizes, anticlockwise from the middle of its side at -y.
Route rectangular_route(std::string name, const Eigen::Vector3d& centre, const Eigen::Vector2d& half_size,
                        double turn_radius_m);

/// The same, in the air.
Route flown(Route route);

double length_of(const Route& route);

}  // namespace plumbline
