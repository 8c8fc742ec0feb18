#include "sim/scenes/ground_and_wall.h"

#include "sim/scenes/open_ground.h"
#include "sim/scenes/palette.h"
#include "sim/scenes/routes.h"
#include "sim/scenes/walls.h"

namespace plumbline {
namespace {

constexpr double kBeyondM = 130.0;  // of the ground and the wall past the route's ends

SceneDescription build_ground_and_wall(const SceneValues& values, std::uint64_t world_seed) {
  const double half_route = values.at("length_m") / 2.0;
  const double reach = half_route + kBeyondM;
  MjcfWriter writer;
  RandomStream ground(world_seed, "ground_and_wall/ground");
  add_open_ground(writer, ground, {-half_route - 40.0, -20.0}, {half_route + 40.0, 40.0},
                  {"asphalt_worn", "asphalt", "gravel_path", "floor_screed"}, reach);

  RandomStream stream(world_seed, "ground_and_wall/wall");
  const double y = -values.at("wall_distance_m");
  std::string material;
  const std::vector<double> cuts = random_cuts(stream, -reach, reach, 4.0, 9.0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    material = pick_other_than(material, stream, wall_materials());
    writer.box(material, {cuts[i - 1], y - 0.3, 0.0}, {cuts[i], y, values.at("wall_height_m")});
  }
  SceneDescription scene = writer.finish("ground_and_wall", scene_palette(), 0.0, 0.0);
  light_by_day(scene);
  scene.routes = {make_route("along_the_wall", {{-half_route, 0.0, 0.0}, {half_route, 0.0, 0.0}}, 0.0)};
  return scene;
}

}  // namespace

SceneInfo ground_and_wall_scene() {
  return {.name = "ground_and_wall",
          .summary = "level ground and one long, smooth wall to the right",
          .parameters = {{"length_m", 80, 20, 400, "of the route along the wall"},
                         {"wall_distance_m", 3, 1, 20, "from the route"},
                         {"wall_height_m", 4, 1, 12, "above the ground"}},
          .build = build_ground_and_wall,
          .usual_lux = kDaylightLux};
}

}  // namespace plumbline
