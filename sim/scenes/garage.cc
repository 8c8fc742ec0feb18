#include "sim/scenes/garage.h"

#include <cmath>
#include <string>

#include "sim/scenes/garage_bays.h"
#include "sim/scenes/garage_plan.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

std::string stream_name(const char* part, int hall) { return "garage/" + std::string(part) + std::to_string(hall); }

void add_boards(MjcfWriter& writer, const Wall& wall, double wall_length, double lowest_m, RandomStream& stream) {
  for (double along = 2.5; along < wall_length - 2.0; along += 5.0) {
    add_fixture(writer, frame_of(wall),
                {.material = pick(stream, sign_materials()),
                 .along_m = along + stream.uniform(-0.8, 0.8),
                 .height_m = lowest_m + stream.uniform(0.0, 0.2),
                 .width_m = stream.uniform(0.7, 1.4),
                 .tall_m = stream.uniform(0.5, 0.8)});
  }
}

// Reaches into its neighbours' thickness at both ends, so that no light gets through the corners.
void add_long_walls(MjcfWriter& writer, const GaragePlan& plan, int hall, RandomStream& stream) {
  const double west = plan.west_of(hall) - GaragePlan::kWallM;
  const double east = west + plan.length + 2.0 * GaragePlan::kWallM;
  const double y = plan.half_width();
  const Wall south{.from = {west, -y}, .to = {east, -y}, .height_m = plan.ceiling};
  const Wall north{.from = {east, y}, .to = {west, y}, .height_m = plan.ceiling};
  for (const Wall& wall : {south, north}) {
    add_wall(writer, wall, wall_materials(), stream);
    add_boards(writer, wall, plan.length, 2.2, stream);
  }
}

void add_cabinets(MjcfWriter& writer, const Wall& wall, RandomStream& stream) {
  for (const double along : {1.2, (wall.to - wall.from).norm() - 1.2}) {
    add_fixture(writer, frame_of(wall),
                {.material = "pipe_red",
                 .along_m = along + stream.uniform(-0.3, 0.3),
                 .height_m = 1.2,
                 .width_m = 0.7,
                 .tall_m = 0.9,
                 .depth_m = 0.25});
  }
}

// The wall between two halls, or the garage's last one.
void add_east_wall(MjcfWriter& writer, const GaragePlan& plan, int hall, RandomStream& stream) {
  const double x = plan.west_of(hall) + plan.length;
  const double y = plan.half_width();
  Wall wall{.from = {x, -y}, .to = {x, y}, .height_m = plan.ceiling};
  if (!plan.is_last(hall)) {
    const double middle = plan.door_y(hall) + y;
    const double half = GaragePlan::kDoorWidthM / 2.0;
    wall.openings = {{middle - half, middle + half, GaragePlan::kDoorHeightM}};
    add_door_frame(writer, wall, wall.openings[0]);
  } else {
    add_boards(writer, wall, plan.width, 1.6, stream);
  }
  add_wall(writer, wall, wall_materials(), stream);
  add_cabinets(writer, wall, stream);
  // A large board on the blind half of each face: the far side of the hall from the door.
  const double blind = plan.is_last(hall) ? y : y - plan.door_y(hall);
  add_fixture(writer, frame_of(wall),
              {.material = pick(stream, sign_materials()),
               .along_m = blind,
               .height_m = 1.6,
               .width_m = 2.4,
               .tall_m = 1.2,
               .depth_m = 0.03});
}

void add_west_wall(MjcfWriter& writer, const GaragePlan& plan, RandomStream& stream) {
  const double y = plan.half_width();
  const Wall wall{.from = {0.0, y}, .to = {0.0, -y}, .height_m = plan.ceiling};
  add_wall(writer, wall, wall_materials(), stream);
  add_boards(writer, wall, plan.width, 1.6, stream);
  add_cabinets(writer, wall, stream);
}

// Strips along the hall, flush: bays, lanes and island each have their own ground.
void add_floor_and_ceiling(MjcfWriter& writer, const GaragePlan& plan, int hall, RandomStream& stream) {
  const double west = plan.west_of(hall) - (hall == 0 ? GaragePlan::kWallM : 0.0);
  const double east = plan.west_of(hall) + plan.length + GaragePlan::kWallM;
  const double outer = plan.half_width() + GaragePlan::kWallM;
  const double front = plan.bay_front();
  const double edges[] = {-outer, -front, -GaragePlan::kIslandHalfM, GaragePlan::kIslandHalfM, front, outer};
  std::string material;
  for (int i = 0; i < 5; ++i) {
    material = pick_other_than(material, stream, road_materials());
    writer.box(material, {west, edges[i], -0.2}, {east, edges[i + 1], 0.0});
  }
  material.clear();
  for (int i = 0; i < 3; ++i) {
    material = pick_other_than(material, stream, {"concrete_pale", "concrete_grey", "plaster", "panels_white"});
    writer.box(material, {west + (east - west) * i / 3, -outer, plan.ceiling},
               {west + (east - west) * (i + 1) / 3, outer, plan.ceiling + 0.2});
  }
}

void add_lane_markings(MjcfWriter& writer, const GaragePlan& plan, int hall) {
  constexpr double kPaintM = 0.004;
  for (const double y : {-GaragePlan::kLaneY, GaragePlan::kLaneY}) {
    for (double x = 2.0; x + 2.5 < plan.length; x += 6.0) {
      const double west = plan.west_of(hall) + x;
      writer.box("road_paint", {west, y - 0.06, 0.0}, {west + 2.5, y + 0.06, kPaintM});
    }
  }
}

void add_pillar(MjcfWriter& writer, const GaragePlan& plan, const Eigen::Vector2d& at, RandomStream& stream) {
  constexpr double kHalf = 0.25;
  writer.box(pick(stream, {"concrete_pale", "concrete_grey", "concrete_dark"}), {at.x() - kHalf, at.y() - kHalf, 0.0},
             {at.x() + kHalf, at.y() + kHalf, plan.ceiling});
  const bool faces_south = at.y() > 0.0;  // towards the lane in front of it
  const Pose face = upright_frame({at.x(), at.y() + (faces_south ? -kHalf : kHalf), 0.0}, faces_south ? M_PI : 0.0);
  add_fixture(writer, face,
              {.material = pick(stream, sign_materials()),
               .height_m = stream.uniform(1.3, 1.9),
               .width_m = 0.4,
               .tall_m = 0.6});
}

void add_pillars_and_beams(MjcfWriter& writer, const GaragePlan& plan, int hall, RandomStream& stream) {
  for (const double row : plan.pillar_rows()) {
    const double x = plan.west_of(hall) + row;
    for (const double y : {-plan.bay_front() - 0.1, 0.0, plan.bay_front() + 0.1}) {
      add_pillar(writer, plan, {x, y}, stream);
    }
    writer.box("concrete_grey", {x - 0.2, -plan.half_width(), plan.ceiling - GaragePlan::kBeamDepthM},
               {x + 0.2, plan.half_width(), plan.ceiling});
  }
}

// Pipes and a duct hang below the beams' upper half, away from the lamps above the lanes.
void add_pipes(MjcfWriter& writer, const GaragePlan& plan, int hall, RandomStream& stream) {
  const double west = plan.west_of(hall);
  const double east = west + plan.length;
  const double wall = plan.half_width();
  for (const double y : {-wall + 0.4, -GaragePlan::kIslandHalfM, GaragePlan::kIslandHalfM, wall - 0.4}) {
    const double z = plan.ceiling - stream.uniform(0.2, 0.4);
    const double radius = stream.uniform(0.05, 0.12);
    writer.cylinder(pick(stream, {"pipe_red", "pipe_galvanised"}), {west, y, z}, {east, y, z}, radius);
  }
  writer.box("pipe_galvanised", {west, plan.bay_front() + 0.5, plan.ceiling - 0.4},
             {east, plan.bay_front() + 1.1, plan.ceiling - 0.05});
}

void add_lamps(MjcfWriter& writer, const GaragePlan& plan, int hall, RandomStream& stream) {
  constexpr double kSpacing = 7.0;
  const int count = static_cast<int>(plan.length / kSpacing);
  for (const double lane : {-GaragePlan::kLaneY, GaragePlan::kLaneY}) {
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d at{plan.west_of(hall) + plan.length * (i + 0.5) / count + stream.uniform(-0.5, 0.5),
                               lane + stream.uniform(-0.3, 0.3), plan.ceiling - GaragePlan::kBeamDepthM - 0.25};
      writer.box("lamp_housing", at + Eigen::Vector3d(-0.6, -0.1, 0.15), at + Eigen::Vector3d(0.6, 0.1, 0.2));
      writer.lamp({at, stream.uniform(200.0, 300.0), 14.0});
    }
  }
}

// Along one lane of every hall, and over to the other one for the door to the next.
Route through_all_halls(const GaragePlan& plan) {
  constexpr double kCrossM = 3.5;  // from the end walls to the cross lanes' middles
  std::vector<Eigen::Vector3d> corners{{6.0, GaragePlan::kLaneY, 0.0}};
  for (int hall = 0; hall < plan.halls; ++hall) {
    const double cross = plan.west_of(hall) + plan.length - kCrossM;
    const double from = -plan.door_y(hall);
    corners.emplace_back(cross, from, 0.0);
    corners.emplace_back(cross, -from, 0.0);
  }
  const double last = plan.west_of(plan.halls - 1);
  corners.emplace_back(last + plan.length - 8.0, corners.back().y(), 0.0);
  return make_route("through_all_halls", corners, 2.0);
}

Route first_hall_loop(const GaragePlan& plan) {
  return rectangular_route("first_hall", {plan.length / 2.0, 0.0, 0.0}, {plan.length / 2.0 - 3.5, GaragePlan::kLaneY},
                           2.0);
}

SceneDescription build_garage(const SceneValues& values, std::uint64_t world_seed) {
  const GaragePlan plan(values, world_seed);
  MjcfWriter writer;
  for (int hall = 0; hall < plan.halls; ++hall) {
    RandomStream structure(world_seed, stream_name("structure", hall));
    if (hall == 0) add_west_wall(writer, plan, structure);
    add_long_walls(writer, plan, hall, structure);
    add_east_wall(writer, plan, hall, structure);
    add_floor_and_ceiling(writer, plan, hall, structure);
    add_lane_markings(writer, plan, hall);
    add_pillars_and_beams(writer, plan, hall, structure);
    add_pipes(writer, plan, hall, structure);
    add_bays(writer, plan, hall);
    RandomStream lamps(world_seed, stream_name("lamps", hall));
    add_lamps(writer, plan, hall, lamps);
  }
  SceneDescription scene = writer.finish("garage", scene_palette(), 30.0, 0.0);
  scene.routes = {through_all_halls(plan), first_hall_loop(plan)};
  return scene;
}

}  // namespace

SceneInfo garage_scene() {
  return {.name = "garage",
          .summary = "underground garage: halls with pillars and parked things, behind one another",
          .parameters = {{"hall_count", 3, 1, 12, "halls in a row along +x", true},
                         {"hall_length_m", 36, 24, 60, "length of each hall along x"},
                         {"hall_width_m", 24, 24, 40, "width of each hall along y"},
                         {"ceiling_m", 3.4, 3.0, 6.0, "clear height"},
                         {"clutter", 0.5, 0, 1, "share of the parking bays that are taken"},
                         {"pillar_spacing_m", 7, 4, 20, "between the rows of pillars"}},
          .build = build_garage};
}

}  // namespace plumbline
