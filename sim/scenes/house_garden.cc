#include "sim/scenes/house_garden.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "sim/scenes/foliage.h"
#include "sim/scenes/houses.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/scenery.h"
#include "sim/scenes/site_things.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPathHalf_m = 0.8;
constexpr double kHedge_m = 9.0;  // from the path to the hedge
constexpr double kReach_m = 120.0;

Vector2d grown(const Vector2d& half, double by) { return half + Vector2d::Constant(by); }

// Level ground between two rectangles, in patches of one look.
void add_ring(MjcfWriter& writer, const std::string& material, const Vector2d& inner, const Vector2d& outer) {
  constexpr double kThick_m = 1.0;
  const auto box = [&](const Vector2d& low, const Vector2d& high) {
    writer.box(material, {low.x(), low.y(), -kThick_m}, {high.x(), high.y(), 0.0});
  };
  box({-outer.x(), -outer.y()}, {outer.x(), -inner.y()});
  box({-outer.x(), inner.y()}, {outer.x(), outer.y()});
  box({-outer.x(), -inner.y()}, {-inner.x(), inner.y()});
  box({inner.x(), -inner.y()}, {outer.x(), inner.y()});
}

struct Place {
  Vector2d at = Vector2d::Zero();
  double yaw = 0.0;  ///< of the way outwards
};

/// A place on a rectangle about the origin, `share` of the way round.
Place on_rectangle(const Vector2d& half, double share) {
  const Vector2d corners[] = {{half.x(), -half.y()}, {half.x(), half.y()}, {-half.x(), half.y()}, -half};
  double left = share * 4.0 * (half.x() + half.y());
  int side = 0;
  for (; side < 3; ++side) {
    const double length = (corners[side + 1] - corners[side]).norm();
    if (left <= length) break;
    left -= length;
  }
  const Vector2d along = (corners[(side + 1) % 4] - corners[side]).normalized();
  return {corners[side] + left * along, side * M_PI / 2.0};
}

void add_trees(Scenery& scenery, const HousePlan& plan) {
  RandomStream stream(plan.seed, "house/trees");
  for (int i = 0; i < plan.trees; ++i) {
    const double out = stream.uniform(4.0, 6.5);
    const auto [place, yaw] = on_rectangle(grown(plan.way_half(), out), (i + stream.uniform(0.1, 0.9)) / plan.trees);
    const Species species = stream.uniform() < 0.5 ? Species::kFruit : Species::kBirch;
    Tree tree = draw_tree(stream, species, 0.6);
    tree.crown_radius_m = std::min(tree.crown_radius_m, 2.8);
    add_tree(scenery, stream, {place.x(), place.y(), 0.0}, tree);
  }
}

void add_hedges(Scenery& scenery, const HousePlan& plan) {
  constexpr double kGateHalf_m = 1.5;
  RandomStream stream(plan.seed, "house/hedges");
  const Vector2d half = grown(plan.way_half(), kHedge_m);
  const auto hedge = [&](double x0, double y0, double x1, double y1) {
    add_hedge(scenery, stream, {x0, y0, 0.0}, {x1, y1, 0.0}, 0.8, stream.uniform(1.2, 1.7), 20.0);
  };
  hedge(half.x(), -half.y(), half.x(), -kGateHalf_m);
  hedge(half.x(), kGateHalf_m, half.x(), half.y());
  hedge(half.x(), half.y(), -half.x(), half.y());
  hedge(-half.x(), half.y(), -half.x(), -half.y());
  hedge(-half.x(), -half.y(), half.x(), -half.y());
}

// Bushes between the walls and the path, but not before the door.
void add_bushes(Scenery& scenery, const HousePlan& plan) {
  constexpr double kSpacing_m = 2.6;
  RandomStream stream(plan.seed, "house/bushes");
  const Vector2d half = grown(plan.outer_half(), 0.8);
  const int count = static_cast<int>(4.0 * (half.x() + half.y()) / kSpacing_m);
  for (int i = 0; i < count; ++i) {
    const auto [place, yaw] = on_rectangle(half, (i + stream.uniform(0.2, 0.8)) / count);
    const bool grows = stream.uniform() < 0.6;
    const double radius = stream.uniform(0.25, 0.5);
    const bool at_door = place.x() > half.x() - 0.1 && std::abs(place.y()) < 2.0;
    if (grows && !at_door) add_bush(scenery, stream, {place.x(), place.y(), 0.0}, radius, stream.uniform(0.6, 1.3), 60);
  }
}

void add_neighbours(Scenery& scenery, const HousePlan& plan) {
  constexpr int kCount = 8;
  RandomStream stream(plan.seed, "house/neighbours");
  for (int i = 0; i < kCount; ++i) {
    const Vector2d half = grown(plan.way_half(), kHedge_m + stream.uniform(10.0, 16.0));
    const auto [place, yaw] = on_rectangle(half, (i + stream.uniform(0.35, 0.65)) / kCount);
    // A house looks along its -y: towards the origin here.
    add_house(scenery, stream, upright_frame({place.x(), place.y(), 0.0}, yaw - M_PI / 2.0), draw_villa(stream));
  }
}

void add_things(MjcfWriter& writer, const HousePlan& plan) {
  constexpr int kLampPosts = 6;
  constexpr double kIntensity_cd = 150.0;
  RandomStream stream(plan.seed, "house/garden");
  const Vector2d half = grown(plan.way_half(), 1.8);
  for (int i = 0; i < kLampPosts; ++i) {
    const auto [place, yaw] = on_rectangle(half, (i + stream.uniform(0.3, 0.7)) / kLampPosts);
    // Its arm reaches over +y: towards the path here.
    add_lamp_post(writer, upright_frame({place.x(), place.y(), 0.0}, yaw + M_PI / 2.0), kIntensity_cd);
    const auto [seat, seat_yaw] = on_rectangle(half, (i + stream.uniform(0.75, 0.95)) / kLampPosts);
    const Pose bench = upright_frame({seat.x(), seat.y(), 0.0}, seat_yaw + M_PI / 2.0);
    if (i % 2 == 0) add_bench(writer, bench);
  }
}

}  // namespace

void add_garden(MjcfWriter& writer, const HousePlan& plan) {
  const Vector2d path_in = grown(plan.way_half(), -kPathHalf_m);
  const Vector2d path_out = grown(plan.way_half(), kPathHalf_m);
  add_ring(writer, "lawn_short", plan.outer_half(), path_in);
  add_ring(writer, "gravel_path", path_in, path_out);
  add_ring(writer, "lawn_short", path_out, grown(path_out, kHedge_m));
  add_ring(writer, "grass", grown(path_out, kHedge_m), Vector2d::Constant(kReach_m));
  const double door = plan.outer_half().x();
  writer.box("stone_pale", {door, -1.2, 0.0}, {door + 1.0, 1.2, HousePlan::kFirstFloor_m});
  Scenery scenery;
  add_trees(scenery, plan);
  add_hedges(scenery, plan);
  add_bushes(scenery, plan);
  add_neighbours(scenery, plan);
  for (SceneMesh& mesh : scenery.take_meshes()) writer.mesh(std::move(mesh));
  add_things(writer, plan);
}

}  // namespace plumbline
