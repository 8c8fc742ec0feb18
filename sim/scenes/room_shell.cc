#include "sim/scenes/room_shell.h"

#include <algorithm>
#include <cmath>

#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

constexpr double kSlabM = 0.2;

void add_closed_door(MjcfWriter& writer, RandomStream& stream, Wall& wall, double along) {
  const Opening door{.begin_m = along - 0.5, .end_m = along + 0.5, .height_m = 2.1};
  wall.openings = {door};
  writer.box(pick(stream, {"door_paint", "door_oak", "wood_brown"}), {door.begin_m, -wall.thickness_m, 0.0},
             {door.end_m, -wall.thickness_m + 0.05, door.height_m}, frame_of(wall));
  writer.box("frame_paint", {door.begin_m, -wall.thickness_m, -kSlabM}, {door.end_m, 0.0, 0.0}, frame_of(wall));
  add_door_frame(writer, wall, door);
}

}  // namespace

std::vector<Wall> add_room_shell(MjcfWriter& writer, RandomStream& stream, const RoomShell& shell) {
  std::vector<Wall> walls = rectangle_walls(shell.half_size, shell.height_m);
  for (Wall& wall : walls) wall.section_m = 4.0;
  if (shell.door_along_m > 0.0) add_closed_door(writer, stream, walls[2], shell.door_along_m);
  for (const Wall& wall : walls) add_wall(writer, wall, shell.walls, stream);

  const double x = shell.half_size.x() + kSlabM;
  const double y = shell.half_size.y() + kSlabM;
  std::string floor;
  std::string ceiling;
  const std::vector<double> cuts = random_cuts(stream, -x, x, 2.5, 5.0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    floor = pick_other_than(floor, stream, shell.floors);
    ceiling = pick_other_than(ceiling, stream, {"plaster", "panels_white", "panels_grey"});
    writer.box(floor, {cuts[i - 1], -y, -kSlabM}, {cuts[i], y, 0.0});
    writer.box(ceiling, {cuts[i - 1], -y, shell.height_m}, {cuts[i], y, shell.height_m + kSlabM});
  }
  return walls;
}

void add_ceiling_lamps(MjcfWriter& writer, RandomStream& stream, const RoomShell& shell, double spacing_m,
                       double intensity_cd) {
  const Eigen::Vector2d size = 2.0 * shell.half_size;
  const int along = std::max(1, static_cast<int>(size.x() / spacing_m));
  const int across = std::max(1, static_cast<int>(size.y() / spacing_m));
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < across; ++j) {
      const double x = size.x() * ((i + 0.5) / along - 0.5) + stream.uniform(-0.15, 0.15);
      const double y = size.y() * ((j + 0.5) / across - 0.5) + stream.uniform(-0.15, 0.15);
      writer.box("lamp_housing", {x - 0.5, y - 0.12, shell.height_m - 0.06}, {x + 0.5, y + 0.12, shell.height_m});
      writer.lamp({{x, y, shell.height_m - 0.35}, intensity_cd * stream.uniform(0.8, 1.2), 3.0 * shell.height_m});
    }
  }
}

}  // namespace plumbline
