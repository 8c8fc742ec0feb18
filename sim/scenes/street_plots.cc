#include <cmath>
#include <numbers>
#include <string>

#include "sim/scenes/foliage.h"
#include "sim/scenes/houses.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/street_furniture.h"
#include "sim/scenes/street_parts.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

/// One side of the street: +1 left, -1 right. Frames have x along the front and y away from the road.
struct Side {
  const StreetPlan& plan;
  double sign;

  double yaw() const { return sign > 0.0 ? 0.0 : std::numbers::pi; }
  Pose stand(double s, double off) const { return plan.stand(s, sign * off, yaw()); }
  Vector3d ground(double s, double off) const { return plan.ground(s, sign * off); }
  double edge(double s) const { return plan.road_half(s) + plan.pavement_width(s); }
};

void add_town_plot(Scenery& scenery, RandomStream& stream, const Side& side, double s, double width) {
  const House house = draw_town_house(stream, width);
  const double setback = stream.uniform(0.1, 0.9);
  add_house(scenery, stream, side.stand(s, side.edge(s) + setback), house);
  if (stream.uniform() < 0.35) {  // a yard tree behind
    const Tree tree = draw_tree(stream, Species::kLinden, 0.5);
    add_tree(scenery, stream, side.ground(s, side.edge(s) + 20.0), tree);
  }
}

void add_front_boundary(Scenery& scenery, RandomStream& stream, const Side& side, double from_s, double to_s) {
  const double off = side.edge(from_s) + 0.5;
  const double gate = stream.uniform(0.25, 0.7);
  const double kind = stream.uniform();
  const double middle = from_s + gate * (to_s - from_s);
  const std::pair<double, double> parts[] = {{from_s, middle - 1.6}, {middle + 1.6, to_s}};
  for (const auto& [begin, end] : parts) {
    if (end - begin < 1.0) continue;
    const Vector3d a = side.ground(begin, off);
    const Vector3d b = side.ground(end, off);
    if (kind < 0.4) {
      add_hedge(scenery, stream, a, b, stream.uniform(0.6, 0.9), stream.uniform(0.9, 1.8), 9.0);
    } else if (kind < 0.65) {
      add_fence(scenery, stream, a, b, Fence::kBoards);
    } else if (kind < 0.85) {
      add_fence(scenery, stream, a, b, Fence::kWall);
    } else {
      add_fence(scenery, stream, a, b, Fence::kRails);
    }
  }
}

void add_suburb_plot(Scenery& scenery, RandomStream& stream, const Side& side, double from_s, double to_s) {
  const double s = 0.5 * (from_s + to_s);
  const House house = draw_villa(stream);
  const double setback = stream.uniform(4.0, 8.0);
  const double askew = stream.uniform(-0.12, 0.12);
  const double shift = stream.uniform(-1.5, 1.5);
  add_house(scenery, stream, side.stand(s + shift, side.edge(s) + setback) * upright_frame(Vector3d::Zero(), askew),
            house);
  add_front_boundary(scenery, stream, side, from_s + 0.3, to_s - 0.3);
  if (stream.uniform() < 0.55) {  // garage or shed beside the house
    const double off = side.edge(s) + setback + stream.uniform(2.0, 5.0);
    const double at = s + shift + house.width_m * 0.5 + 2.4;
    const Pose frame = side.stand(at, off);
    scenery.block(house.wall, {-1.5, 0.0, -1.0}, {1.5, 5.0, 2.4}, frame);
    scenery.box("roof_gravel", {-1.7, -0.3, 2.4}, {1.7, 5.2, 2.55}, frame);
    scenery.block("door_paint", {-1.2, -0.06, -0.3}, {1.2, 0.0, 2.1}, frame);
  }
  const int trees = stream.integer(0, 2);
  for (int i = 0; i < trees; ++i) {
    const double off = side.edge(s) + (i == 0 ? stream.uniform(1.8, 3.6) : setback + 13.0);
    const auto species = static_cast<Species>(stream.integer(0, 4));
    Tree tree = draw_tree(stream, species, 0.7);
    tree.crown_radius_m = std::min(tree.crown_radius_m, 2.3);
    add_tree(scenery, stream, side.ground(stream.uniform(from_s + 1.5, to_s - 1.5), off), tree);
  }
  const int bushes = stream.integer(1, 3);
  for (int i = 0; i < bushes; ++i) {
    const Vector3d foot =
        side.ground(stream.uniform(from_s + 1.0, to_s - 1.0), side.edge(s) + stream.uniform(1.8, setback));
    add_bush(scenery, stream, foot, stream.uniform(0.5, 0.9), stream.uniform(0.7, 1.5), 30);
  }
}

void add_works_plot(Scenery& scenery, RandomStream& stream, const Side& side, double from_s, double to_s) {
  const double s = 0.5 * (from_s + to_s);
  const Hall hall{.width_m = std::min(to_s - from_s - 4.0, 34.0),
                  .depth_m = stream.uniform(12.0, 20.0),
                  .eaves_m = stream.uniform(4.5, 8.0),
                  .wall = pick(stream, cladding_materials())};
  const double setback = stream.uniform(5.0, 9.0);
  add_hall_building(scenery, stream, side.stand(s, side.edge(s) + setback), hall);
  const double off = side.edge(s) + 0.4;
  add_fence(scenery, stream, side.ground(from_s, off), side.ground(s - 4.0, off), Fence::kMesh);
  add_fence(scenery, stream, side.ground(s + 4.0, off), side.ground(to_s, off), Fence::kMesh);
  for (int i = 0; i < 4; ++i) {  // stores in the yard
    const Pose frame = side.stand(stream.uniform(from_s + 3.0, to_s - 3.0), side.edge(s) + stream.uniform(1.8, 3.4));
    if (stream.uniform() < 0.5) {
      const double size = stream.uniform(0.4, 0.8);
      scenery.block(pick(stream, crate_materials()), {-size, -size, -0.3}, {size, size, 2.0 * size}, frame);
    } else {
      scenery.rod(pick(stream, barrel_materials()), frame * Vector3d(0.0, 0.0, -0.2), frame * Vector3d(0.0, 0.0, 1.0),
                  0.35, 0.35, 8);
    }
  }
}

void add_farm(Scenery& scenery, RandomStream& stream, const Side& side, double s) {
  House house = draw_villa(stream);
  house.roof = Roof::kGableAlong;
  add_house(scenery, stream, side.stand(s - 9.0, side.edge(s) + stream.uniform(8.0, 13.0)), house);
  const Hall barn{.width_m = stream.uniform(9.0, 13.0),
                  .depth_m = stream.uniform(12.0, 18.0),
                  .eaves_m = stream.uniform(3.5, 5.5),
                  .wall = "barn_boards"};
  add_hall_building(scenery, stream, side.stand(s + 9.0, side.edge(s) + stream.uniform(10.0, 16.0)), barn);
}

/// Plots one after the other, of the district where they begin.
void add_side(Scenery& scenery, const Side& side, std::uint64_t seed) {
  RandomStream stream(seed, side.sign > 0.0 ? "street/plots/left" : "street/plots/right");
  double s = stream.uniform(2.0, 6.0);
  const double end = side.plan.line().length();
  while (s < end) {
    const District district = side.plan.stretch_at(s).district;
    double width = 0.0;
    switch (district) {
      case District::kTown:
        width = stream.uniform(8.5, 17.0);
        break;
      case District::kSuburb:
        width = stream.uniform(17.0, 26.0);
        break;
      case District::kWorks:
        width = stream.uniform(26.0, 44.0);
        break;
      case District::kFields:
      case District::kWood:
        width = stream.uniform(60.0, 150.0);
        break;
    }
    const std::uint64_t plot = stream.bits();
    const double farm_s = s + 0.5 * width;
    const double from = is_rural(district) ? farm_s - 18.0 : s;
    const double to = is_rural(district) ? farm_s + 18.0 : s + width;
    const bool fits = to <= end && !side.plan.is_kept_free(from, to, district == District::kTown ? 1.5 : 2.5) &&
                      side.plan.stretch_at(to).district == district;
    s += width + (district == District::kTown && stream.uniform() < 0.15 ? stream.uniform(2.0, 6.0) : 0.0);
    if (!fits) {
      // Squeezed towards the obstacle in small steps, so that rows end close to it.
      if (!is_rural(district)) s -= width - 3.0;
      continue;
    }
    RandomStream own(plot, "plot");
    if (district == District::kTown) add_town_plot(scenery, own, side, 0.5 * (from + to), to - from);
    if (district == District::kSuburb) add_suburb_plot(scenery, own, side, from, to);
    if (district == District::kWorks) add_works_plot(scenery, own, side, from, to);
    if (district == District::kFields && own.uniform() < 0.6) add_farm(scenery, own, side, farm_s);
  }
}

}  // namespace

void add_plots(Scenery& scenery, const StreetPlan& plan, std::uint64_t seed) {
  for (const double sign : {-1.0, 1.0}) add_side(scenery, {plan, sign}, seed);
}

}  // namespace plumbline
