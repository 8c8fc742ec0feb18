#pragma once

#include <string>
#include <vector>

#include "sim/random_stream.h"
#include "sim/world.h"

namespace plumbline {

/// Every material of the procedural scenes. Reflectivities follow what lidars report of such surfaces at 905 nm: dark
/// rubber and asphalt near 0.1, concrete 0.3 to 0.5, white paint 0.8, signs (retro-reflecting film) near 1.
const std::vector<Material>& scene_palette();

/// Names in scene_palette(), by use.
const std::vector<std::string>& wall_materials();
const std::vector<std::string>& sign_materials();
const std::vector<std::string>& vehicle_materials();
const std::vector<std::string>& car_paints();
const std::vector<std::string>& facade_materials();
const std::vector<std::string>& roof_materials();
const std::vector<std::string>& cladding_materials();
const std::vector<std::string>& crate_materials();
const std::vector<std::string>& barrel_materials();
const std::vector<std::string>& road_materials();
const std::vector<std::string>& wood_materials();
const std::vector<std::string>& fabric_materials();  ///< carpets and upholstery
const std::vector<std::string>& room_wall_materials();
const std::vector<std::string>& indoor_floor_materials();

std::string pick(RandomStream& stream, const std::vector<std::string>& names);
/// Never the one just used, so that neighbouring sections differ. `names` holds at least two.
std::string pick_other_than(const std::string& last, RandomStream& stream, const std::vector<std::string>& names);

}  // namespace plumbline
