#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/random_stream.h"
#include "sim/scenes/scenery.h"

namespace plumbline {

enum class Species { kLinden, kPoplar, kBirch, kSpruce, kFruit };

/// A tree of a trunk, branches and loose leaf sprays, through which rays find gaps. No two are alike: lobes, branches
/// and every spray come from the stream.
struct Tree {
  Species species = Species::kLinden;
  double height_m = 8.0;
  double crown_radius_m = 2.5;  ///< no spray reaches farther from the trunk than this and half a spray
  double bole_m = 2.5;          ///< below which there is nothing but the trunk
  int sprays = 300;
  double spray_m = 0.45;  ///< typical size of a spray
};

/// A tree of a species with measures as grown along streets; more sprays for a larger `density` (1: some 450).
Tree draw_tree(RandomStream& stream, Species species, double density);

void add_tree(Scenery& scenery, RandomStream& stream, const Eigen::Vector3d& foot, const Tree& tree);

/// Sprays about a place, half as high as wide or more.
void add_bush(Scenery& scenery, RandomStream& stream, const Eigen::Vector3d& foot, double radius_m, double height_m,
              int sprays);

/// A trimmed hedge: a dark core with sprays standing out of it.
void add_hedge(Scenery& scenery, RandomStream& stream, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
               double width_m, double height_m, double sprays_per_m);

/// A few blades standing up from a place.
void add_grass_tuft(Scenery& scenery, RandomStream& stream, const Eigen::Vector3d& foot, double height_m, int blades,
                    const std::string& material);

}  // namespace plumbline
