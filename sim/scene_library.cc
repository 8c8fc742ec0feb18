#include "sim/scene_library.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "sim/scenes/bridge.h"
#include "sim/scenes/building.h"
#include "sim/scenes/campus.h"
#include "sim/scenes/composite_loop.h"
#include "sim/scenes/conference_room.h"
#include "sim/scenes/corridor.h"
#include "sim/scenes/dark_room.h"
#include "sim/scenes/flat.h"
#include "sim/scenes/garage.h"
#include "sim/scenes/ground_and_wall.h"
#include "sim/scenes/hall.h"
#include "sim/scenes/highway.h"
#include "sim/scenes/house.h"
#include "sim/scenes/lawn.h"
#include "sim/scenes/lobby.h"
#include "sim/scenes/orchard.h"
#include "sim/scenes/shed_site.h"
#include "sim/scenes/sphere.h"
#include "sim/scenes/street.h"
#include "sim/scenes/striped_walls.h"
#include "sim/scenes/trail.h"
#include "sim/scenes/tunnel.h"
#include "sim/scenes/vegetated_road.h"

namespace plumbline {
namespace {

template <typename Named>
std::string names_of(const std::vector<Named>& things) {
  std::string names;
  for (const Named& thing : things) names += (names.empty() ? "" : ", ") + thing.name;
  return names;
}

template <typename Named>
const Named* find_named(const std::vector<Named>& things, const std::string& name) {
  const auto found = std::find_if(things.begin(), things.end(), [&](const Named& thing) { return thing.name == name; });
  return found == things.end() ? nullptr : &*found;
}

void check_value(const SceneInfo& scene, const SceneParameter& parameter, double value) {
  const bool in_range = value >= parameter.min && value <= parameter.max;  // false for NaN
  if (in_range && (!parameter.whole || value == std::floor(value))) return;
  std::ostringstream message;
  message << "scene " << scene.name << ": " << parameter.name << " is " << value << "; allowed "
          << (parameter.whole ? "are whole numbers from " : "is ") << parameter.min << " to " << parameter.max;
  throw std::invalid_argument(message.str());
}

SceneValues complete_values(const SceneInfo& scene, const SceneValues& overrides) {
  SceneValues values;
  for (const SceneParameter& parameter : scene.parameters) values[parameter.name] = parameter.default_value;
  for (const auto& [name, value] : overrides) {
    const SceneParameter* parameter = find_named(scene.parameters, name);
    if (!parameter) {
      throw std::invalid_argument("scene " + scene.name + " has no parameter '" + name + "'; it has " +
                                  names_of(scene.parameters));
    }
    check_value(scene, *parameter, value);
    values[name] = value;
  }
  return values;
}

}  // namespace

const std::vector<SceneInfo>& scene_library() {
  static const std::vector<SceneInfo> scenes = {
      garage_scene(),   corridor_scene(),  tunnel_scene(),          hall_scene(),           lobby_scene(),
      building_scene(), house_scene(),     conference_room_scene(), dark_room_scene(),      striped_walls_scene(),
      sphere_scene(),   flat_scene(),      ground_and_wall_scene(), street_scene(),         campus_scene(),
      highway_scene(),  bridge_scene(),    orchard_scene(),         vegetated_road_scene(), trail_scene(),
      lawn_scene(),     shed_site_scene(), composite_loop_scene()};
  return scenes;
}

SceneDescription build_scene(const std::string& name, const SceneValues& overrides, std::uint64_t world_seed) {
  const SceneInfo* scene = find_named(scene_library(), name);
  if (!scene) throw std::invalid_argument("no scene '" + name + "'; there are " + names_of(scene_library()));
  return scene->build(complete_values(*scene, overrides), world_seed);
}

}  // namespace plumbline
