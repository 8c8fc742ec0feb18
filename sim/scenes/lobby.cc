#include "sim/scenes/lobby.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/scenes/furniture.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/room_shell.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/stairs.h"

namespace plumbline {
namespace {

constexpr double kGalleryM = 3.6;       // height of its floor
constexpr double kGalleryDepthM = 3.0;  // from the wall
constexpr double kColumnsToWallM = 5.0;
constexpr double kFlightWidthM = 1.4;
constexpr double kLandingM = 1.6;

struct Plan {
  Eigen::Vector2d half = Eigen::Vector2d::Zero();
  double height = 0.0;
  double column_spacing = 0.0;
  double furniture = 0.0;
  std::uint64_t seed = 0;

  double columns_y() const { return half.y() - kColumnsToWallM; }
  double gallery_y() const { return half.y() - kGalleryDepthM; }
  Eigen::Vector2d way() const { return {half.x() - 3.8, columns_y() - 1.6}; }
};

// Panes between mullions and transoms, before the wall.
void add_glass_front(MjcfWriter& writer, const Plan& plan, const Wall& wall) {
  RandomStream stream(plan.seed, "lobby/front");
  const Pose frame = frame_of(wall);
  const double length = (wall.to - wall.from).norm();
  writer.box("glass", {0.0, 0.0, 0.0}, {length, 0.02, plan.height}, frame);
  for (const double along : random_cuts(stream, 0.2, length - 0.2, 1.4, 2.4)) {
    writer.box("frame_paint", {along - 0.05, 0.02, 0.0}, {along + 0.05, 0.2, plan.height}, frame);
  }
  for (double z = 0.1; z < plan.height; z += stream.uniform(1.7, 2.4)) {
    writer.box("frame_paint", {0.0, 0.02, z - 0.04}, {length, 0.12, z + 0.04}, frame);
  }
  for (double along = 2.0; along < length - 2.0; along += stream.uniform(3.0, 5.0)) {  // things stuck to the panes
    const double z = stream.uniform(1.2, 2.2);
    writer.box(pick(stream, sign_materials()), {along - 0.3, 0.02, z - 0.3}, {along + 0.3, 0.03, z + 0.3}, frame);
  }
}

void add_columns(MjcfWriter& writer, const Plan& plan) {
  RandomStream stream(plan.seed, "lobby/columns");
  const double reach = plan.half.x() - 3.0;
  const int gaps = std::max(1, static_cast<int>(std::lround(2.0 * reach / plan.column_spacing)));
  for (int i = 0; i <= gaps; ++i) {
    const double x = -reach + 2.0 * reach * i / gaps;
    for (const double y : {-plan.columns_y(), plan.columns_y()}) {
      const std::string material = pick(stream, {"concrete_pale", "plaster", "brick_pale", "wood_brown"});
      if (stream.uniform() < 0.5) {
        writer.cylinder(material, {x, y, 0.0}, {x, y, plan.height}, 0.3);
      } else {
        writer.box(material, {x - 0.3, y - 0.3, 0.0}, {x + 0.3, y + 0.3, plan.height});
      }
    }
  }
}

void add_reception(MjcfWriter& writer, const Plan& plan) {
  RandomStream stream(plan.seed, "lobby/reception");
  const Pose frame = upright_frame({plan.half.x() / 2.0 - 0.6, 0.0, 0.0}, M_PI / 2.0);  // y towards -x, the visitors
  writer.box("wood_brown", {-1.8, 0.0, 0.0}, {1.8, 0.15, 1.1}, frame);
  writer.box("concrete_pale", {-1.9, -0.2, 1.1}, {1.9, 0.3, 1.15}, frame);
  writer.box("wood_pale", {-1.8, -0.75, 0.7}, {1.8, 0.0, 0.75}, frame);
  for (const double x : {-1.0, 0.7}) writer.box("plastic_black", {x, -0.35, 0.78}, {x + 0.5, -0.32, 1.12}, frame);
  add_chair(writer, stream, frame * upright_frame({-0.6, -1.1, 0.0}, M_PI / 2.0));
  writer.box("panels_blue", {-1.5, -1.9, 0.0}, {1.5, -1.75, 2.6}, frame);
  writer.box("sign_white", {-1.0, -1.75, 1.5}, {1.0, -1.72, 2.3}, frame);
}

// Sofas around a low table on a carpet.
void add_seats(MjcfWriter& writer, RandomStream& stream, const Eigen::Vector3d& at, double yaw) {
  const Pose frame = upright_frame(at, yaw);
  writer.box(pick(stream, {"carpet_red", "carpet_blue", "carpet_grey"}), {-1.7, -1.5, 0.0}, {1.7, 1.5, 0.012}, frame);
  for (const double side : {0.0, M_PI}) {
    add_sofa(writer, stream,
             frame * upright_frame(Eigen::Vector3d::Zero(), side) * upright_frame({0.0, -1.6, 0.0}, 0.0),
             stream.uniform(1.4, 2.2));
  }
  writer.box(pick(stream, wood_materials()), {-0.5, -0.3, 0.3}, {0.5, 0.3, 0.38}, frame);
  writer.box("steel", {-0.1, -0.1, 0.0}, {0.1, 0.1, 0.3}, frame);
  writer.box("notice_board", {-0.3, -0.15, 0.38}, {0.0, 0.15, 0.4}, frame);
}

void add_furniture(MjcfWriter& writer, const Plan& plan) {
  RandomStream stream(plan.seed, "lobby/seats");
  add_seats(writer, stream, {-plan.half.x() / 2.0, 0.0, 0.0}, 0.0);
  const double y = -plan.half.y() + 2.6;  // between the columns and the front
  for (double x = -plan.half.x() + 3.5; x < plan.half.x() - 3.0; x += 4.5) {
    RandomStream own(plan.seed, "lobby/seats" + std::to_string(std::lround(x * 10.0)));
    const bool taken = own.uniform() < plan.furniture;
    if (taken) add_seats(writer, own, {x, y, 0.0}, own.uniform(-0.1, 0.1));
    add_plant(writer, own, upright_frame({x + 2.25, y + own.uniform(-1.0, 0.6), 0.0}, 0.0), own.uniform(1.4, 2.6));
  }
  for (double x = 0.0; x < plan.half.x() - 2.0; x += 5.0) {
    add_plant(writer, stream, upright_frame({x + 1.5, plan.half.y() - 0.8, 0.0}, 0.0), stream.uniform(1.2, 2.2));
  }
}

Flight flight_of(const Plan& /*plan*/) {
  return {.risers = riser_count(kGalleryM, 1), .rise_m = kGalleryM, .tread_m = 0.29, .width_m = kFlightWidthM};
}

Eigen::Vector3d foot_of_stairs(const Plan& plan) {
  return {-plan.half.x() / 2.0, plan.gallery_y() - kFlightWidthM / 2.0 - 0.1, 0.0};
}

void add_gallery(MjcfWriter& writer, const Plan& plan) {
  RandomStream stream(plan.seed, "lobby/gallery");
  const Flight flight = flight_of(plan);
  const Eigen::Vector3d foot = foot_of_stairs(plan);
  add_flight(writer, "wood_pale", flight, upright_frame(foot, 0.0), true, true);

  const double top = foot.x() + flight.run_m();
  const double south = foot.y() - kFlightWidthM / 2.0;
  const double y = plan.gallery_y();
  writer.box("concrete_grey", {top, south, kGalleryM - 0.25}, {top + kLandingM, y, kGalleryM});
  std::string floor;
  const std::vector<double> cuts = random_cuts(stream, -plan.half.x(), plan.half.x(), 4.0, 7.0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    floor = pick_other_than(floor, stream, indoor_floor_materials());
    writer.box(floor, {cuts[i - 1], y, kGalleryM - 0.25}, {cuts[i], plan.half.y(), kGalleryM});
  }
  const double z = kGalleryM;
  add_rail(writer, {-plan.half.x(), y + 0.06, z}, {top - 0.05, y + 0.06, z});
  add_rail(writer, {top + kLandingM, y + 0.06, z}, {plan.half.x(), y + 0.06, z});
  add_rail(writer, {top, south + 0.05, z}, {top + kLandingM - 0.05, south + 0.05, z});
  add_rail(writer, {top + kLandingM - 0.05, south + 0.05, z}, {top + kLandingM - 0.05, y, z});
}

void add_pictures(MjcfWriter& writer, const Plan& plan, const std::vector<Wall>& walls) {
  RandomStream stream(plan.seed, "lobby/pictures");
  for (std::size_t i = 1; i < walls.size(); ++i) {
    const double length = (walls[i].to - walls[i].from).norm();
    for (double along = 1.5; along < length - 1.5; along += stream.uniform(2.0, 3.5)) {
      const Pose frame = frame_of(walls[i]) * upright_frame({along, 0.0, 0.0}, 0.0);
      add_picture(writer, stream, frame, stream.uniform(1.5, 2.0));
      add_picture(writer, stream, frame, stream.uniform(5.0, 5.4));
    }
  }
}

Route up_the_stairs(const Plan& plan) {
  const Flight flight = flight_of(plan);
  const Eigen::Vector3d foot = foot_of_stairs(plan);
  const double landing = foot.x() + flight.run_m() + kLandingM / 2.0;
  const double gallery = plan.gallery_y() + kGalleryDepthM / 2.0;
  return make_route("up_the_stairs",
                    {foot + Eigen::Vector3d(-2.5, 0.0, 0.0),
                     foot + Eigen::Vector3d(-flight.tread_m, 0.0, 0.0),
                     foot + Eigen::Vector3d(flight.run_m(), 0.0, kGalleryM),
                     {landing, foot.y(), kGalleryM},
                     {landing, gallery, kGalleryM},
                     {plan.half.x() - 1.5, gallery, kGalleryM}},
                    0.4);
}

SceneDescription build_lobby(const SceneValues& values, std::uint64_t world_seed) {
  const Plan plan{.half = {values.at("length_m") / 2.0, values.at("width_m") / 2.0},
                  .height = values.at("height_m"),
                  .column_spacing = values.at("column_spacing_m"),
                  .furniture = values.at("furniture"),
                  .seed = world_seed};
  MjcfWriter writer;
  RandomStream shell_stream(world_seed, "lobby/shell");
  const RoomShell shell{.half_size = plan.half,
                        .height_m = plan.height,
                        .floors = {"floor_tiles", "concrete_pale", "wood_floor"},
                        .walls = room_wall_materials()};
  const std::vector<Wall> walls = add_room_shell(writer, shell_stream, shell);
  add_glass_front(writer, plan, walls[0]);
  add_columns(writer, plan);
  add_reception(writer, plan);
  add_furniture(writer, plan);
  add_gallery(writer, plan);
  add_pictures(writer, plan, walls);
  RandomStream lamps(world_seed, "lobby/lamps");
  add_ceiling_lamps(writer, lamps, shell, 5.0, 500.0);
  SceneDescription scene = writer.finish("lobby", scene_palette(), 60.0, 0.0);
  scene.routes = {rectangular_route("around", Eigen::Vector3d::Zero(), plan.way(), 1.5), up_the_stairs(plan)};
  return scene;
}

}  // namespace

SceneInfo lobby_scene() {
  return {.name = "lobby",
          .summary = "high lobby with columns, a glass front, a reception, seats, and stairs to a gallery",
          .parameters = {{"length_m", 30, 24, 60, "along x"},
                         {"width_m", 20, 19, 40, "along y"},
                         {"height_m", 8, 6.2, 14, "of the ceiling"},
                         {"column_spacing_m", 6, 4, 15, "between columns along x"},
                         {"furniture", 0.7, 0, 1, "share of the places for seats at the front that are taken"}},
          .build = build_lobby};
}

}  // namespace plumbline
