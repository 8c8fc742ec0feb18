#include "sim/scenes/foliage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

Vector3d random_direction(RandomStream& stream) {
  const double z = stream.uniform(-1.0, 1.0);
  const double angle = stream.uniform(0.0, 2.0 * std::numbers::pi);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// A three-cornered spray about a centre, facing anywhere, a little more often outwards.
void add_spray(Scenery& scenery, RandomStream& stream, const std::string& material, const Vector3d& centre,
               const Vector3d& outward, double size) {
  const Vector3d normal = (random_direction(stream) + 0.5 * outward).normalized();
  const Vector3d u = normal.unitOrthogonal();
  const Vector3d v = normal.cross(u);
  const double turn = stream.uniform(0.0, 2.0 * std::numbers::pi);
  const auto corner = [&](double angle, double reach) {
    return Vector3d(centre + reach * size * (std::cos(turn + angle) * u + std::sin(turn + angle) * v));
  };
  scenery.triangle(material, corner(0.0, stream.uniform(0.5, 0.8)), corner(2.1, stream.uniform(0.35, 0.6)),
                   corner(4.2, stream.uniform(0.35, 0.6)));
}

struct Lobe {
  Vector3d centre;  // about the foot
  double radius = 0.0;
};

/// Parts of the crown, each on a branch of its own.
std::vector<Lobe> draw_lobes(RandomStream& stream, const Tree& tree) {
  const double half = 0.5 * (tree.height_m - tree.bole_m);
  const Vector3d middle(0.0, 0.0, tree.bole_m + half);
  const int count = tree.species == Species::kPoplar ? 7 : stream.integer(5, 8);
  std::vector<Lobe> lobes;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i * 0.618 + stream.uniform(0.0, 0.25));
    const double level = -0.75 + 1.5 * (i + stream.uniform(0.1, 0.9)) / count;
    const double reach = tree.crown_radius_m * std::sqrt(std::max(0.1, 1.0 - level * level)) * stream.uniform(0.3, 0.6);
    const double radius = std::min(tree.crown_radius_m - reach, 0.55 * half) * stream.uniform(0.8, 1.0);
    const double rise = std::clamp(level * half, radius - half, half - radius);
    lobes.push_back({middle + Vector3d(reach * std::cos(angle), reach * std::sin(angle), rise), radius});
  }
  return lobes;
}

const char* leaf_material(Species species) {
  switch (species) {
    case Species::kPoplar:
      return "foliage_pale";
    case Species::kBirch:
      return "foliage_yellow";
    case Species::kSpruce:
      return "foliage_dark";
    case Species::kLinden:
    case Species::kFruit:
      break;
  }
  return "foliage_green";
}

void add_broad_crown(Scenery& scenery, RandomStream& stream, const Vector3d& foot, const Tree& tree,
                     const std::string& bark, double trunk_radius) {
  const std::string material = leaf_material(tree.species);
  const std::vector<Lobe> lobes = draw_lobes(stream, tree);
  for (const Lobe& lobe : lobes) {
    const double start = std::min(stream.uniform(0.75, 1.0) * lobe.centre.z(), tree.bole_m + 0.3);
    const Vector3d root = foot + Vector3d(0.0, 0.0, start);
    scenery.rod(bark, root, foot + lobe.centre, 0.45 * trunk_radius, 0.15 * trunk_radius, 3);
  }
  for (int i = 0; i < tree.sprays; ++i) {
    const Lobe& lobe = lobes[static_cast<std::size_t>(i) % lobes.size()];
    const Vector3d out = random_direction(stream);
    const double depth = std::cbrt(stream.uniform(0.15, 1.0));
    const double size = tree.spray_m * stream.uniform(0.6, 1.3);
    Vector3d centre = lobe.centre + depth * lobe.radius * out;
    centre.z() = std::max(centre.z(), tree.bole_m + 0.8 * size);
    add_spray(scenery, stream, material, foot + centre, out, size);
  }
}

/// Whorls of drooping boughs around the trunk, shorter towards the top.
void add_spruce_crown(Scenery& scenery, RandomStream& stream, const Vector3d& foot, const Tree& tree) {
  for (int i = 0; i < tree.sprays; ++i) {
    const double level = 1.0 - std::sqrt(stream.uniform());
    const double reach = tree.crown_radius_m * (1.0 - level) * stream.uniform(0.55, 1.0) + 0.1;
    const double angle = stream.uniform(0.0, 2.0 * std::numbers::pi);
    const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const Vector3d side(-out.y(), out.x(), 0.0);
    const double base = tree.bole_m + level * (tree.height_m - tree.bole_m);
    const double droop = stream.uniform(0.1, 0.45) * reach;
    const Vector3d middle = foot + Vector3d(0.0, 0.0, std::max(base, tree.bole_m + droop)) + 0.35 * reach * out;
    const double width = tree.spray_m * stream.uniform(0.5, 1.0);
    const Vector3d tip = middle + 0.65 * reach * out - Vector3d(0.0, 0.0, droop);
    const Vector3d tilt(0.0, 0.0, stream.uniform(-0.2, 0.2) * width);
    scenery.triangle("foliage_dark", tip, middle + width * side + tilt, middle - width * side - tilt);
  }
}

}  // namespace

Tree draw_tree(RandomStream& stream, Species species, double density) {
  Tree tree;
  tree.species = species;
  const double size = stream.uniform(0.75, 1.3);
  switch (species) {
    case Species::kLinden:
      tree = {species, 8.5 * size, 2.9 * size, 2.6, 520, 0.58};
      break;
    case Species::kPoplar:
      tree = {species, 14.0 * size, 1.7 * size, 2.4, 520, 0.55};
      break;
    case Species::kBirch:
      tree = {species, 9.5 * size, 2.1 * size, 2.8, 450, 0.46};
      break;
    case Species::kSpruce:
      tree = {species, 11.0 * size, 2.4 * size, 0.7, 380, 0.50};
      break;
    case Species::kFruit:
      tree = {species, 4.2 * size, 1.8 * size, 1.1, 420, 0.32};
      break;
  }
  // Denser trees have smaller sprays, not fuller crowns.
  tree.sprays = static_cast<int>(tree.sprays * density);
  tree.spray_m /= std::pow(density, 0.4);
  return tree;
}

void add_tree(Scenery& scenery, RandomStream& stream, const Vector3d& foot, const Tree& tree) {
  const std::string bark = tree.species == Species::kBirch ? "bark_birch" : "bark";
  const double radius = 0.016 * tree.height_m + 0.05;
  const bool straight = tree.species == Species::kSpruce || tree.species == Species::kPoplar;
  const double top = straight ? 0.96 * tree.height_m : tree.bole_m + 0.35 * (tree.height_m - tree.bole_m);
  const Vector3d lean(stream.uniform(-0.2, 0.2), stream.uniform(-0.2, 0.2), 0.0);
  const Vector3d fork = foot + (straight ? 0.3 : 1.0) * lean * (tree.bole_m / 2.5) + Vector3d(0.0, 0.0, tree.bole_m);
  scenery.rod(bark, foot - Vector3d(0.0, 0.0, 0.3), foot + Vector3d(0.0, 0.0, 0.25), 1.5 * radius, radius, 6);
  scenery.rod(bark, foot + Vector3d(0.0, 0.0, 0.2), fork, radius, 0.8 * radius, 6);
  scenery.rod(bark, fork - Vector3d(0.0, 0.0, 0.05), {fork.x(), fork.y(), foot.z() + top}, 0.8 * radius, 0.2 * radius,
              5);
  if (tree.species == Species::kSpruce) return add_spruce_crown(scenery, stream, foot, tree);
  add_broad_crown(scenery, stream, foot + Vector3d(fork.x() - foot.x(), fork.y() - foot.y(), 0.0), tree, bark, radius);
}

void add_bush(Scenery& scenery, RandomStream& stream, const Vector3d& foot, double radius_m, double height_m,
              int sprays) {
  const std::string material = stream.uniform() < 0.5 ? "foliage_dark" : "foliage_green";
  for (int i = 0; i < 3; ++i) {
    const Vector3d lean(stream.uniform(-0.5, 0.5) * radius_m, stream.uniform(-0.5, 0.5) * radius_m, 0.7 * height_m);
    scenery.rod("bark", foot - Vector3d(0.0, 0.0, 0.1), foot + lean, 0.03, 0.01, 3);
  }
  for (int i = 0; i < sprays; ++i) {
    const Vector3d out = random_direction(stream);
    const double depth = std::cbrt(stream.uniform(0.2, 1.0));
    const Vector3d centre = foot + Vector3d(radius_m * depth * out.x(), radius_m * depth * out.y(),
                                            0.55 * height_m + 0.45 * height_m * depth * out.z());
    add_spray(scenery, stream, material, centre, out, stream.uniform(0.16, 0.34) * (0.6 + 0.4 * radius_m));
  }
}

void add_hedge(Scenery& scenery, RandomStream& stream, const Vector3d& from, const Vector3d& to, double width_m,
               double height_m, double sprays_per_m) {
  const Vector3d along = to - from;
  const double length = along.norm();
  const Vector3d direction = along / length;
  const Vector3d left = Vector3d::UnitZ().cross(direction).normalized();
  const Pose frame{Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(direction.y(), direction.x()), Vector3d::UnitZ())),
                   from};
  const double half = 0.5 * width_m;
  const double rise = to.z() - from.z();
  scenery.prism("foliage_dark",
                {{0.0, -0.4}, {length, rise - 0.4}, {length, rise + height_m - 0.12}, {0.0, height_m - 0.12}},
                -half + 0.12, half - 0.12, frame);
  const int count = static_cast<int>(length * sprays_per_m);
  const double skin = 2.0 * height_m + width_m;
  for (int i = 0; i < count; ++i) {
    const double around = stream.uniform(0.0, skin);
    Vector3d out = Vector3d::UnitZ();
    double side = around - height_m - half;
    double up = height_m;
    if (around < height_m || around > height_m + width_m) {
      const double sign = around < height_m ? -1.0 : 1.0;
      out = sign * left;
      side = sign * half;
      up = around < height_m ? around : around - height_m - width_m;
    }
    const Vector3d centre = from + stream.uniform() * along +
                            (side + stream.uniform(-0.15, 0.0) * out.dot(left)) * left +
                            Vector3d(0.0, 0.0, up - stream.uniform(0.0, 0.12) * out.z());
    const char* material = stream.uniform() < 0.6 ? "foliage_green" : "foliage_dark";
    add_spray(scenery, stream, material, centre, out, stream.uniform(0.14, 0.28));
  }
}

void add_grass_tuft(Scenery& scenery, RandomStream& stream, const Vector3d& foot, double height_m, int blades,
                    const std::string& material) {
  for (int i = 0; i < blades; ++i) {
    const double angle = stream.uniform(0.0, 2.0 * std::numbers::pi);
    const Vector3d side(std::cos(angle), std::sin(angle), 0.0);
    const Vector3d lean(stream.uniform(-0.35, 0.35) * height_m, stream.uniform(-0.35, 0.35) * height_m, 0.0);
    const Vector3d base = foot + Vector3d(stream.uniform(-0.12, 0.12), stream.uniform(-0.12, 0.12), -0.02);
    const double width = stream.uniform(0.015, 0.05);
    scenery.triangle(material, base - width * side, base + width * side,
                     base + lean + Vector3d(0.0, 0.0, height_m * stream.uniform(0.6, 1.2)));
  }
}

}  // namespace plumbline
