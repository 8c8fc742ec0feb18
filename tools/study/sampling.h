#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Designs that fill a unit cube more evenly than a grid of as many points would.
namespace plumbline {

/// `count` points of the unit cube, one coordinate per name, each in [0, 1).
using UnitPoints = std::vector<std::vector<double>>;

/// Each coordinate takes every one of `count` equal strata once, at a random place in it; the same names give the same
/// points, and a coordinate's column depends on its own name alone.
/// Source: McKay, Beckman and Conover, "A comparison of three methods ...", Technometrics 21 (1979).
UnitPoints latin_hypercube(std::size_t count, const std::vector<std::string>& names);

/// The most dimensions that sobol_points knows.
constexpr std::size_t kSobolDimensions = 16;

/// Points 1 ... count of the Sobol sequence, its first point (the corner) left out.
/// Direction numbers: Joe and Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci.
/// Comput. 30 (2008), file new-joe-kuo-6.21201.
/// @throws std::invalid_argument for more than kSobolDimensions dimensions
UnitPoints sobol_points(std::size_t count, std::size_t dimensions);

}  // namespace plumbline
