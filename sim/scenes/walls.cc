#include "sim/scenes/walls.h"

#include <algorithm>
#include <cmath>

#include "sim/scenes/palette.h"

namespace plumbline {
namespace {

constexpr double kFrameProudM = 0.03;
constexpr double kFrameInsideM = 0.05;
constexpr double kFrameOutsideM = 0.10;

double length_of(const Wall& wall) { return (wall.to - wall.from).norm(); }

// Equal sections from `begin` to `end` along the wall, over its whole height.
void add_solid_part(MjcfWriter& writer, const Wall& wall, double begin, double end,
                    const std::vector<std::string>& materials, RandomStream& stream) {
  const double length = end - begin;
  if (length <= 0.0) return;
  const int sections = std::max(1, static_cast<int>(std::ceil(length / wall.section_m)));
  const Pose world_from_wall = frame_of(wall);
  std::string material;
  for (int i = 0; i < sections; ++i) {
    material = pick_other_than(material, stream, materials);
    writer.box(material, {begin + length * i / sections, -wall.thickness_m, 0.0},
               {begin + length * (i + 1) / sections, 0.0, wall.height_m}, world_from_wall);
  }
}

}  // namespace

std::vector<Wall> rectangle_walls(const Eigen::Vector2d& half_size, double height_m) {
  const double x = half_size.x();
  const double y = half_size.y();
  std::vector<Wall> walls(4);
  const double outer = x + walls[0].thickness_m;
  walls[0].from = {-outer, -y};
  walls[0].to = {outer, -y};
  walls[1].from = {x, -y};
  walls[1].to = {x, y};
  walls[2].from = {outer, y};
  walls[2].to = {-outer, y};
  walls[3].from = {-x, y};
  walls[3].to = {-x, -y};
  for (Wall& wall : walls) wall.height_m = height_m;
  return walls;
}

Pose frame_of(const Wall& wall) {
  const Eigen::Vector2d along = wall.to - wall.from;
  return upright_frame({wall.from.x(), wall.from.y(), wall.floor_m}, std::atan2(along.y(), along.x()));
}

void add_wall(MjcfWriter& writer, const Wall& wall, const std::vector<std::string>& materials, RandomStream& stream) {
  double begin = 0.0;
  for (const Opening& opening : wall.openings) {
    add_solid_part(writer, wall, begin, opening.begin_m, materials, stream);
    if (opening.height_m < wall.height_m) {
      writer.box(pick(stream, materials), {opening.begin_m, -wall.thickness_m, opening.height_m},
                 {opening.end_m, 0.0, wall.height_m}, frame_of(wall));
    }
    if (opening.sill_m > 0.0) {
      writer.box(pick(stream, materials), {opening.begin_m, -wall.thickness_m, 0.0},
                 {opening.end_m, 0.0, opening.sill_m}, frame_of(wall));
    }
    begin = opening.end_m;
  }
  add_solid_part(writer, wall, begin, length_of(wall), materials, stream);
}

void add_door_frame(MjcfWriter& writer, const Wall& wall, const Opening& opening) {
  const Pose world_from_wall = frame_of(wall);
  const double back = -wall.thickness_m - kFrameProudM;
  const double left = opening.begin_m;
  const double right = opening.end_m;
  const double top = opening.height_m;
  writer.box("frame_paint", {left - kFrameOutsideM, back, opening.sill_m}, {left + kFrameInsideM, kFrameProudM, top},
             world_from_wall);
  writer.box("frame_paint", {right - kFrameInsideM, back, opening.sill_m}, {right + kFrameOutsideM, kFrameProudM, top},
             world_from_wall);
  writer.box("frame_paint", {left - kFrameOutsideM, back, top - kFrameInsideM},
             {right + kFrameOutsideM, kFrameProudM, top + kFrameOutsideM}, world_from_wall);
}

void add_window_frame(MjcfWriter& writer, const Wall& wall, const Opening& opening) {
  constexpr double kBarHalfM = 0.03;
  const Pose world_from_wall = frame_of(wall);
  const double sill = opening.sill_m;
  const double middle = (opening.begin_m + opening.end_m) / 2.0;
  const double bar = sill + 0.6 * (opening.height_m - sill);
  const double pane = -wall.thickness_m / 2.0;
  add_door_frame(writer, wall, opening);
  writer.box("frame_paint", {opening.begin_m - kFrameOutsideM, -wall.thickness_m - 0.08, sill - 0.04},
             {opening.end_m + kFrameOutsideM, 0.12, sill + 0.02}, world_from_wall);
  writer.box("frame_paint", {middle - kBarHalfM, pane - kBarHalfM, sill},
             {middle + kBarHalfM, pane + kBarHalfM, opening.height_m}, world_from_wall);
  writer.box("frame_paint", {opening.begin_m, pane - kBarHalfM, bar - kBarHalfM},
             {opening.end_m, pane + kBarHalfM, bar + kBarHalfM}, world_from_wall);
}

void add_fixture(MjcfWriter& writer, const Pose& world_from_wall, const Fixture& fixture) {
  const Eigen::Vector3d half(fixture.width_m / 2.0, 0.0, fixture.tall_m / 2.0);
  const Eigen::Vector3d middle(fixture.along_m, 0.0, fixture.height_m);
  writer.box(fixture.material, middle - half, middle + half + Eigen::Vector3d(0.0, fixture.depth_m, 0.0),
             world_from_wall);
}

std::vector<double> random_cuts(RandomStream& stream, double from, double to, double shortest, double longest) {
  std::vector<double> cuts{from};
  while (to - cuts.back() > longest) {
    // Leaves at least one shortest stretch, so that the last one is no sliver.
    const double room = std::min(longest, to - cuts.back() - shortest);
    const double cut = cuts.back() + stream.uniform(std::min(shortest, room), room);
    cuts.push_back(std::round(cut * 100.0) / 100.0);
  }
  cuts.push_back(to);
  return cuts;
}

}  // namespace plumbline
