#include "sim/scenes/striped_walls.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/scenes/corridor_legs.h"
#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

enum class Look { kOrdinary, kUpright, kLevel, kBlank };

constexpr Look kLooks[] = {Look::kOrdinary, Look::kUpright, Look::kBlank,   Look::kOrdinary,
                           Look::kLevel,    Look::kBlank,   Look::kOrdinary};

bool striped(Look look) { return look == Look::kUpright || look == Look::kLevel; }

std::vector<double> leg_lengths(const SceneValues& values) {
  std::vector<double> lengths;
  for (const Look look : kLooks) {
    lengths.push_back(values.at(striped(look) ? "striped_m" : look == Look::kBlank ? "blank_m" : "ordinary_m"));
  }
  return lengths;
}

// Level stripes run through from end to end; upright ones are laid anew every few metres, so that they do not repeat.
void add_wall_of(MjcfWriter& writer, Wall wall, Look look, RandomStream& stream) {
  if (look == Look::kOrdinary) return add_wall(writer, wall, wall_materials(), stream);
  const char* material = look == Look::kUpright ? "stripes_vertical"
                         : look == Look::kLevel ? "stripes_horizontal"
                                                : "blank_wall";
  const double length = (wall.to - wall.from).norm();
  const std::vector<double> cuts =
      look == Look::kUpright ? random_cuts(stream, 0.0, length, 2.0, 4.0) : std::vector<double>{0.0, length};
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    writer.box(material, {cuts[i - 1], -wall.thickness_m, 0.0}, {cuts[i], 0.0, wall.height_m}, frame_of(wall));
  }
}

void add_floor_and_ceiling(MjcfWriter& writer, const Leg& leg, Look look, RandomStream& stream) {
  const double y = leg.floor_half_width();
  const bool ordinary = look == Look::kOrdinary;
  std::string floor = "blank_wall";
  std::string ceiling = "blank_wall";
  const std::vector<double> cuts = random_cuts(stream, leg.floor_begin(), leg.floor_end(), 3.0, 6.0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if (ordinary) floor = pick_other_than(floor, stream, indoor_floor_materials());
    if (ordinary) ceiling = pick_other_than(ceiling, stream, {"plaster", "panels_white", "panels_grey"});
    writer.box(floor, {cuts[i - 1], -y, -0.2}, {cuts[i], y, 0.0}, leg.world_from_leg);
    writer.box(ceiling, {cuts[i - 1], -y, leg.height}, {cuts[i], y, leg.height + 0.2}, leg.world_from_leg);
  }
}

// No housings: nothing but the stripes is to be seen.
void add_lamps(MjcfWriter& writer, const Leg& leg, RandomStream& stream) {
  constexpr double kSpacing = 3.0;
  const int count = std::max(1, static_cast<int>(leg.length / kSpacing));
  for (int i = 0; i < count; ++i) {
    const double along = leg.length * (i + 0.5) / count;
    writer.lamp({leg.world_from_leg * Eigen::Vector3d(along, 0.0, leg.height - 0.4), stream.uniform(60.0, 80.0), 9.0});
  }
}

// In an ordinary leg, boards that stick out a little.
void add_boards(MjcfWriter& writer, const Wall& wall, RandomStream& stream) {
  const double length = (wall.to - wall.from).norm();
  for (double along = 1.5; along < length - 1.0; along += stream.uniform(1.6, 2.6)) {
    add_fixture(writer, frame_of(wall),
                {.material = pick(stream, sign_materials()),
                 .along_m = along,
                 .height_m = stream.uniform(1.2, 1.8),
                 .width_m = stream.uniform(0.5, 1.0),
                 .tall_m = stream.uniform(0.4, 0.9),
                 .depth_m = 0.03});
  }
}

void add_leg(MjcfWriter& writer, const Leg& leg, Look look, std::uint64_t seed) {
  RandomStream stream(seed, leg.name);
  for (const int side : {Leg::kLeft, Leg::kRight}) {
    const Wall wall = side_wall(leg, side);
    add_wall_of(writer, wall, look, stream);
    if (look == Look::kOrdinary) add_boards(writer, wall, stream);
  }
  add_floor_and_ceiling(writer, leg, look, stream);
  add_lamps(writer, leg, stream);
}

SceneDescription build_striped_walls(const SceneValues& values, std::uint64_t world_seed) {
  MjcfWriter writer;
  const std::vector<Leg> legs =
      make_legs("striped_walls", leg_lengths(values), values.at("width_m"), values.at("height_m"));
  for (std::size_t i = 0; i < legs.size(); ++i) add_leg(writer, legs[i], kLooks[i], world_seed);
  RandomStream ends(world_seed, "striped_walls/ends");
  add_wall(writer, first_wall(legs.front()), wall_materials(), ends);
  add_wall(writer, last_wall(legs.back()), wall_materials(), ends);
  SceneDescription scene = writer.finish("striped_walls", scene_palette(), 40.0, 0.0);
  scene.routes = {centre_line("through", legs)};
  return scene;
}

}  // namespace

SceneInfo striped_walls_scene() {
  return {.name = "striped_walls",
          .summary = "corridor with turns: stretches with upright stripes only, level stripes only, and blank ones",
          .parameters = {{"striped_m", 12, 6, 40, "of each leg with stripes, from corner to corner"},
                         {"blank_m", 6, 4, 40, "of each leg with nothing on its walls"},
                         {"ordinary_m", 14, 6, 40, "of each of the other legs"},
                         {"width_m", 2.5, 1.8, 4, "from wall to wall"},
                         {"height_m", 2.6, 2.4, 4, "of the ceiling"}},
          .build = build_striped_walls};
}

}  // namespace plumbline
