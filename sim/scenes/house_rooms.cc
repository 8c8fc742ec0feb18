#include "sim/scenes/house_rooms.h"

#include <cmath>
#include <string>
#include <vector>

#include "sim/scenes/furniture.h"
#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

/// Something that stands at a wall, its back in the middle of `width_m`.
struct Piece {
  double width_m = 1.0;
  bool tall = false;  ///< not before a window
  void (*add)(MjcfWriter&, RandomStream&, const Pose&) = nullptr;
};

using Pieces = std::vector<Piece>;

const Piece kBookcase{1.0, true, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                        add_bookcase(writer, stream, back, 1.0, stream.uniform(1.1, 1.9));
                      }};
const Piece kCupboard{1.2, true, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                        add_cupboard(writer, stream, back, {1.2, 0.5, stream.uniform(1.7, 2.05)});
                      }};
const Piece kSideboard{1.5, false, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                         add_cupboard(writer, stream, back, {1.5, 0.45, 0.8});
                       }};
const Piece kSofa{2.0, false, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                    add_sofa(writer, stream, back, 2.0);
                  }};
const Piece kBed{2.2, false, add_bed};
const Piece kDesk{1.5, false, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                    add_desk(writer, stream, back, stream.uniform() < 0.7);
                  }};
const Piece kShelf{1.5, true, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                     add_shelf(writer, stream, back, 1.5, 1.8);
                   }};
const Piece kKitchen{2.6, true, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                       add_kitchen(writer, stream, back, 2.6);
                     }};
const Piece kPlant{0.8, false, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                     add_plant(writer, stream, back * upright_frame({0.0, 0.4, 0.0}, 0.0), stream.uniform(0.9, 1.5));
                   }};
const Piece kCrates{
    1.0, false, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
      const double wide = stream.uniform(0.5, 0.9);
      const double tall = stream.uniform(0.4, 0.8);
      writer.box(pick(stream, crate_materials()), {-wide / 2.0, 0.05, 0.0}, {wide / 2.0, 0.75, tall}, back);
      writer.box(pick(stream, crate_materials()), {-0.2, 0.15, tall}, {0.25, 0.6, tall + 0.35}, back);
    }};
const Piece kBoiler{0.9, true, [](MjcfWriter& writer, RandomStream& stream, const Pose& back) {
                      writer.cylinder(pick(stream, barrel_materials()), {0.0, 0.45, 0.0}, {0.0, 0.45, 1.6}, 0.38, back);
                      writer.cylinder("pipe_galvanised", {0.0, 0.45, 1.6}, {0.0, 0.45, 2.2}, 0.06, back);
                      writer.cylinder("pipe_red", {-0.25, 0.06, 0.6}, {-0.25, 0.06, 2.2}, 0.03, back);
                    }};

Pieces pieces_of(int level, std::size_t room) {
  if (level == 0) {
    static const std::vector<Pieces> kinds = {
        {kShelf, kCrates}, {kBoiler, kShelf, kCrates}, {kDesk, kShelf, kCupboard}};
    return kinds[room % kinds.size()];
  }
  if (level == 1) {
    static const std::vector<Pieces> kinds = {
        {kSofa, kBookcase, kPlant}, {kSideboard, kPlant, kCupboard}, {kKitchen, kSideboard}};
    return kinds[room % kinds.size()];
  }
  static const std::vector<Pieces> kinds = {
      {kBed, kCupboard, kPlant}, {kDesk, kBookcase, kSofa}, {kBed, kSideboard, kCupboard, kDesk}};
  return kinds[(room + static_cast<std::size_t>(level)) % kinds.size()];
}

/// A wall of a room and its part along which things may stand.
struct Side {
  Wall wall;
  double begin_m = 0.0;
  double end_m = 0.0;
};

std::vector<Side> sides_of(const HouseRoom& room, double floor) {
  constexpr double kCorner_m = 1.1;  // what stands at the long sides' ends
  const Eigen::Vector2d corners[] = {room.low, {room.high.x(), room.low.y()}, room.high, {room.low.x(), room.high.y()}};
  std::vector<Side> sides(4);
  for (std::size_t i = 0; i < 4; ++i) {
    sides[i].wall.from = corners[i];
    sides[i].wall.to = corners[(i + 1) % 4];
    sides[i].wall.floor_m = floor;
    const double margin = i % 2 == 0 ? 0.05 : kCorner_m;
    sides[i].begin_m = margin;
    sides[i].end_m = (sides[i].wall.to - sides[i].wall.from).norm() - margin;
  }
  return sides;
}

bool is_free(const std::vector<HouseOpening>& openings, const Side& side, double begin, double end, bool tall) {
  constexpr double kDoorMargin_m = 0.35;
  for (const HouseOpening& opening : openings) {
    const bool door = opening.sill_m == 0.0;
    if (!door && !tall) continue;
    if (is_in_wall(opening, side.wall, begin, end, door ? kDoorMargin_m : 0.1)) return false;
  }
  return true;
}

void furnish_side(MjcfWriter& writer, RandomStream& stream, const Side& side, const Pieces& pieces,
                  const std::vector<HouseOpening>& openings, double density) {
  double along = side.begin_m;
  while (along < side.end_m) {
    const Piece& piece = pieces[static_cast<std::size_t>(stream.integer(0, static_cast<int>(pieces.size()) - 1))];
    const bool taken = stream.uniform() < density;
    const double end = along + piece.width_m;
    const bool fits = end <= side.end_m && is_free(openings, side, along, end, piece.tall);
    if (taken && fits) {
      piece.add(writer, stream, frame_of(side.wall) * upright_frame({along + piece.width_m / 2.0, 0.0, 0.0}, 0.0));
      along = end + stream.uniform(0.1, 1.2);
    } else {
      along += taken ? 0.3 : 1.8;
    }
  }
}

// Where a wall has neither doors nor windows.
void add_pictures(MjcfWriter& writer, RandomStream& stream, const Side& side,
                  const std::vector<HouseOpening>& openings) {
  constexpr double kHalf_m = 0.6;
  const double length = (side.wall.to - side.wall.from).norm();
  for (double along = stream.uniform(0.8, 1.6); along < length - 0.8; along += stream.uniform(2.0, 3.5)) {
    if (!is_free(openings, side, along - kHalf_m, along + kHalf_m, true)) continue;
    add_picture(writer, stream, frame_of(side.wall) * upright_frame({along, 0.0, 0.0}, 0.0), stream.uniform(1.5, 1.7));
  }
}

// In a corner room's outer part, where no way leads.
void add_table_with_chairs(MjcfWriter& writer, RandomStream& stream, const HousePlan& plan, const HouseRoom& room,
                           double floor) {
  const double end = room.low.x() > 0.0 ? 1.0 : -1.0;
  const Vector3d at(end * (plan.half.x() - 1.7), room.middle().y(), floor);
  add_table(writer, stream, upright_frame(at, 0.0), {0.9, 1.2});
  for (const double side : {-1.0, 1.0}) {
    const Vector3d place = at + Vector3d(side * stream.uniform(0.5, 0.62), stream.uniform(-0.2, 0.2), 0.0);
    add_chair(writer, stream, upright_frame(place, (side > 0.0 ? M_PI : 0.0) + stream.uniform(-0.25, 0.25)));
  }
  writer.cylinder("plastic_white", at + Vector3d(0.1, -0.2, 0.74), at + Vector3d(0.1, -0.2, 0.95), 0.06);
}

void add_lamp(MjcfWriter& writer, RandomStream& stream, const HousePlan& plan, const Eigen::Vector2d& at,
              double floor) {
  constexpr double kIntensity_cd = 80.0;
  const double ceiling = floor + plan.clear_m();
  const double x = at.x() + stream.uniform(-0.2, 0.2);
  const double y = at.y() + stream.uniform(-0.2, 0.2);
  writer.cylinder("lamp_housing", {x, y, ceiling - 0.1}, {x, y, ceiling}, 0.22);
  writer.lamp({{x, y, ceiling - 0.25}, kIntensity_cd * stream.uniform(0.8, 1.2), 8.0});
}

void furnish_hall(MjcfWriter& writer, const HousePlan& plan, int level, const std::vector<HouseOpening>& openings) {
  constexpr double kDensity = 0.5;  // of what is narrow enough to walk past
  RandomStream stream(plan.seed, "house/hall" + std::to_string(level));
  const double floor = plan.floor_of(level);
  const HouseRoom hall{.low = {-plan.half.x(), -HousePlan::kHallHalf_m},
                       .high = {plan.half.x(), HousePlan::kHallHalf_m}};
  const std::vector<Side> sides = sides_of(hall, floor);
  furnish_side(writer, stream, sides[0], {kBookcase, kSideboard}, openings, kDensity * plan.furniture);
  for (const Side& side : sides) add_pictures(writer, stream, side, openings);
  for (const double share : {-0.7, 0.0, 0.7}) {
    add_lamp(writer, stream, plan, {share * plan.half.x(), -0.6}, floor);
  }
}

}  // namespace

void furnish_level(MjcfWriter& writer, const HousePlan& plan, int level) {
  const double floor = plan.floor_of(level);
  std::vector<HouseOpening> openings = plan.inner_doors();
  for (const HouseOpening& opening : plan.outer_openings(level)) openings.push_back(opening);
  const std::vector<HouseRoom> rooms = plan.rooms();
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    RandomStream stream(plan.seed, "house/room" + std::to_string(level) + "/" + std::to_string(i));
    add_lamp(writer, stream, plan, rooms[i].middle(), floor);
    for (const Side& side : sides_of(rooms[i], floor)) {
      furnish_side(writer, stream, side, pieces_of(level, i), openings, plan.furniture);
    }
    add_pictures(writer, stream, sides_of(rooms[i], floor)[i % 2 == 0 ? 0 : 2], openings);
    const bool table = rooms[i].corner && level > 0 && stream.uniform() < plan.furniture;
    if (table) add_table_with_chairs(writer, stream, plan, rooms[i], floor);
  }
  furnish_hall(writer, plan, level, openings);
}

}  // namespace plumbline
