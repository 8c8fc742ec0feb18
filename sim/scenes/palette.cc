#include "sim/scenes/palette.h"

namespace plumbline {

using Pattern = Material::Pattern;

namespace {

/// Of luminance 1, so that the albedo stays the surface's luminance.
Eigen::Vector3f tint(float red, float green, float blue) {
  return Eigen::Vector3f(red, green, blue) / (0.2126F * red + 0.7152F * green + 0.0722F * blue);
}

}  // namespace

const std::vector<Material>& scene_palette() {
  // name, pattern, albedo, contrast, reflectivity at 905 nm, tint, two-sided (leaves and blades)
  static const std::vector<Material> materials = {
      {"concrete_pale", Pattern::kConcrete, 0.58F, 1.0F, 0.50F, tint(1.0F, 0.98F, 0.94F)},
      {"concrete_grey", Pattern::kConcrete, 0.42F, 1.0F, 0.40F},
      {"concrete_dark", Pattern::kConcrete, 0.28F, 1.0F, 0.30F},
      {"plaster", Pattern::kConcrete, 0.70F, 0.8F, 0.65F, tint(1.0F, 0.97F, 0.91F)},
      {"brick_red", Pattern::kBrick, 0.30F, 1.0F, 0.40F, tint(1.0F, 0.50F, 0.38F)},
      {"brick_pale", Pattern::kBrick, 0.50F, 1.0F, 0.50F, tint(1.0F, 0.86F, 0.64F)},
      {"panels_white", Pattern::kPanels, 0.70F, 1.0F, 0.70F},
      {"panels_blue", Pattern::kPanels, 0.26F, 1.0F, 0.35F, tint(0.42F, 0.66F, 1.0F)},
      {"panels_green", Pattern::kPanels, 0.38F, 1.0F, 0.45F, tint(0.58F, 1.0F, 0.66F)},
      {"panels_grey", Pattern::kPanels, 0.48F, 1.0F, 0.45F},
      {"sign_yellow", Pattern::kSigns, 0.60F, 1.0F, 0.95F, tint(1.0F, 0.84F, 0.18F)},
      {"sign_blue", Pattern::kSigns, 0.35F, 1.0F, 0.90F, tint(0.32F, 0.58F, 1.0F)},
      {"sign_white", Pattern::kSigns, 0.72F, 1.0F, 0.95F},
      {"notice_board", Pattern::kSigns, 0.50F, 1.0F, 0.50F},
      {"asphalt", Pattern::kAsphalt, 0.16F, 1.0F, 0.12F},
      {"asphalt_worn", Pattern::kAsphalt, 0.24F, 1.0F, 0.18F},
      {"floor_screed", Pattern::kConcrete, 0.36F, 1.0F, 0.30F},
      {"floor_tiles", Pattern::kPanels, 0.45F, 0.8F, 0.35F, tint(1.0F, 0.92F, 0.82F)},
      {"floor_lino", Pattern::kAsphalt, 0.38F, 0.8F, 0.30F, tint(0.80F, 1.0F, 0.90F)},
      {"road_paint", Pattern::kAsphalt, 0.75F, 0.6F, 0.85F},
      {"steel", Pattern::kPanels, 0.40F, 0.7F, 0.45F},
      {"lamp_housing", Pattern::kPlain, 0.80F, 0.2F, 0.70F},
      {"pipe_red", Pattern::kPanels, 0.24F, 0.8F, 0.40F, tint(1.0F, 0.30F, 0.24F)},
      {"pipe_galvanised", Pattern::kPanels, 0.52F, 0.8F, 0.50F},
      {"door_paint", Pattern::kPanels, 0.33F, 0.8F, 0.40F, tint(0.52F, 0.72F, 1.0F)},
      {"door_oak", Pattern::kPanels, 0.22F, 1.0F, 0.40F, tint(1.0F, 0.66F, 0.36F)},
      {"frame_paint", Pattern::kConcrete, 0.20F, 0.5F, 0.30F},
      {"car_white", Pattern::kPanels, 0.68F, 0.6F, 0.60F},
      {"car_red", Pattern::kPanels, 0.22F, 0.6F, 0.45F, tint(1.0F, 0.26F, 0.22F)},
      {"car_grey", Pattern::kPanels, 0.35F, 0.6F, 0.25F},
      {"car_black", Pattern::kPanels, 0.10F, 0.6F, 0.08F},
      {"rubber", Pattern::kAsphalt, 0.08F, 0.6F, 0.08F},
      {"crate_wood", Pattern::kBrick, 0.45F, 1.0F, 0.50F, tint(1.0F, 0.78F, 0.48F)},
      {"crate_board", Pattern::kSigns, 0.52F, 1.0F, 0.55F, tint(1.0F, 0.80F, 0.54F)},
      {"barrel_blue", Pattern::kPanels, 0.25F, 1.0F, 0.30F, tint(0.34F, 0.56F, 1.0F)},
      {"barrel_orange", Pattern::kSigns, 0.45F, 1.0F, 0.60F, tint(1.0F, 0.56F, 0.16F)},
      {"wood_pale", Pattern::kWood, 0.45F, 1.0F, 0.55F, {1.25F, 0.97F, 0.60F}},
      {"wood_brown", Pattern::kWood, 0.22F, 1.0F, 0.45F, {1.40F, 0.94F, 0.45F}},
      {"wood_dark", Pattern::kWood, 0.10F, 1.0F, 0.30F, {1.50F, 0.90F, 0.50F}},
      {"wood_floor", Pattern::kWood, 0.30F, 1.0F, 0.45F, {1.30F, 0.96F, 0.50F}},
      {"carpet_grey", Pattern::kFabric, 0.25F, 1.0F, 0.35F},
      {"carpet_red", Pattern::kFabric, 0.15F, 1.0F, 0.40F, {2.20F, 0.70F, 0.50F}},
      {"carpet_blue", Pattern::kFabric, 0.14F, 1.0F, 0.30F, {0.60F, 0.95F, 2.60F}},
      {"fabric_green", Pattern::kFabric, 0.20F, 1.0F, 0.40F, {0.60F, 1.20F, 0.50F}},
      {"fabric_grey", Pattern::kFabric, 0.32F, 1.0F, 0.45F},
      {"fabric_white", Pattern::kFabric, 0.68F, 0.6F, 0.70F},
      {"plastic_black", Pattern::kPlain, 0.05F, 0.5F, 0.08F},
      {"plastic_white", Pattern::kPlain, 0.72F, 0.5F, 0.70F},
      {"glass", Pattern::kPlain, 0.08F, 1.0F, 0.06F, {0.80F, 1.02F, 1.30F}},
      {"white_board", Pattern::kSigns, 0.75F, 0.5F, 0.75F},
      {"book_spines", Pattern::kStripesVertical, 0.30F, 1.0F, 0.40F, {1.20F, 0.97F, 0.75F}},
      {"plant_leaves", Pattern::kFoliage, 0.14F, 1.0F, 0.55F, {0.60F, 1.22F, 0.30F}},
      {"plant_pot", Pattern::kConcrete, 0.28F, 0.8F, 0.45F, {1.70F, 0.86F, 0.55F}},
      {"hedge", Pattern::kFoliage, 0.12F, 1.0F, 0.50F, {0.60F, 1.22F, 0.35F}},
      {"tree_bark", Pattern::kConcrete, 0.16F, 1.0F, 0.40F, {1.25F, 0.97F, 0.65F}},
      {"lawn_short", Pattern::kGrass, 0.18F, 1.0F, 0.50F, {0.75F, 1.16F, 0.35F}},
      {"gravel_path", Pattern::kGravel, 0.35F, 1.0F, 0.35F, {1.10F, 0.99F, 0.85F}},
      {"roof_felt", Pattern::kAsphalt, 0.20F, 1.0F, 0.20F},
      {"blank_wall", Pattern::kPlain, 0.50F, 0.0F, 0.50F},
      {"stripes_vertical", Pattern::kStripesVertical, 0.50F, 1.0F, 0.50F},
      {"stripes_horizontal", Pattern::kStripesHorizontal, 0.50F, 1.0F, 0.50F},
      {"plaster_cream", Pattern::kConcrete, 0.62F, 0.8F, 0.60F, tint(1.0F, 0.90F, 0.68F)},
      {"plaster_ochre", Pattern::kConcrete, 0.45F, 0.9F, 0.50F, tint(1.0F, 0.74F, 0.40F)},
      {"plaster_rose", Pattern::kConcrete, 0.48F, 0.9F, 0.52F, tint(1.0F, 0.70F, 0.58F)},
      {"plaster_white", Pattern::kConcrete, 0.72F, 0.7F, 0.68F},
      {"plaster_grey", Pattern::kConcrete, 0.38F, 1.0F, 0.40F, tint(0.92F, 0.96F, 1.0F)},
      {"facade_brick", Pattern::kBrick, 0.28F, 1.0F, 0.40F, tint(1.0F, 0.52F, 0.38F)},
      {"facade_clinker", Pattern::kBrick, 0.20F, 1.0F, 0.32F, tint(1.0F, 0.70F, 0.60F)},
      {"facade_windows", Pattern::kFacade, 0.40F, 1.0F, 0.42F},
      {"cladding_grey", Pattern::kPanels, 0.50F, 0.9F, 0.45F},
      {"cladding_green", Pattern::kPanels, 0.32F, 0.9F, 0.40F, tint(0.55F, 1.0F, 0.60F)},
      {"cladding_red", Pattern::kPanels, 0.24F, 0.9F, 0.42F, tint(1.0F, 0.40F, 0.30F)},
      {"barn_boards", Pattern::kWood, 0.22F, 1.0F, 0.40F, tint(1.0F, 0.72F, 0.48F)},
      {"stone_pale", Pattern::kConcrete, 0.55F, 0.9F, 0.50F, tint(1.0F, 0.97F, 0.88F)},
      {"stone_dark", Pattern::kBrick, 0.26F, 1.0F, 0.32F, tint(1.0F, 0.95F, 0.86F)},
      {"roof_tiles", Pattern::kBrick, 0.24F, 1.0F, 0.38F, tint(1.0F, 0.45F, 0.30F)},
      {"roof_slate", Pattern::kBrick, 0.13F, 1.0F, 0.22F, tint(0.85F, 0.92F, 1.0F)},
      {"roof_brown", Pattern::kBrick, 0.17F, 1.0F, 0.30F, tint(1.0F, 0.66F, 0.46F)},
      {"roof_gravel", Pattern::kGravel, 0.34F, 0.9F, 0.35F},
      {"roof_metal", Pattern::kPanels, 0.45F, 0.7F, 0.45F},
      {"frame_white", Pattern::kPlain, 0.72F, 0.5F, 0.70F},
      {"shutter_green", Pattern::kPanels, 0.16F, 0.7F, 0.35F, tint(0.50F, 1.0F, 0.62F)},
      {"awning_red", Pattern::kPanels, 0.26F, 0.8F, 0.50F, tint(1.0F, 0.28F, 0.24F)},
      {"awning_blue", Pattern::kPanels, 0.20F, 0.8F, 0.45F, tint(0.40F, 0.62F, 1.0F)},
      {"railing", Pattern::kPanels, 0.20F, 0.8F, 0.30F},
      {"lamp_glass", Pattern::kPlain, 0.66F, 0.3F, 0.90F},
      {"sign_red", Pattern::kSigns, 0.24F, 1.0F, 0.90F, tint(1.0F, 0.22F, 0.20F)},
      {"car_blue", Pattern::kPanels, 0.14F, 0.5F, 0.30F, tint(0.35F, 0.55F, 1.0F)},
      {"car_silver", Pattern::kPanels, 0.48F, 0.5F, 0.45F},
      {"kerb", Pattern::kConcrete, 0.46F, 1.0F, 0.42F},
      {"paving", Pattern::kBrick, 0.36F, 0.9F, 0.36F},
      {"gravel", Pattern::kGravel, 0.32F, 1.0F, 0.34F, tint(1.0F, 0.93F, 0.80F)},
      {"field", Pattern::kGravel, 0.17F, 1.0F, 0.26F, tint(1.0F, 0.72F, 0.50F)},
      {"grass", Pattern::kGrass, 0.16F, 1.0F, 0.46F, tint(0.62F, 1.0F, 0.30F), true},
      {"grass_dry", Pattern::kGrass, 0.26F, 1.0F, 0.48F, tint(1.0F, 0.92F, 0.48F), true},
      {"foliage_green", Pattern::kFoliage, 0.15F, 1.0F, 0.50F, tint(0.55F, 1.0F, 0.28F), true},
      {"foliage_pale", Pattern::kFoliage, 0.22F, 1.0F, 0.52F, tint(0.72F, 1.0F, 0.42F), true},
      {"foliage_dark", Pattern::kFoliage, 0.09F, 1.0F, 0.42F, tint(0.50F, 1.0F, 0.45F), true},
      {"foliage_yellow", Pattern::kFoliage, 0.26F, 1.0F, 0.52F, tint(1.0F, 0.96F, 0.30F), true},
      {"bark", Pattern::kGravel, 0.12F, 1.0F, 0.30F, tint(1.0F, 0.80F, 0.62F)},
      {"bark_birch", Pattern::kGravel, 0.55F, 1.0F, 0.50F},
      {"rock", Pattern::kConcrete, 0.30F, 1.0F, 0.35F, tint(1.0F, 0.96F, 0.90F)},
      {"water", Pattern::kPlain, 0.05F, 0.6F, 0.02F, tint(0.70F, 0.95F, 1.0F)},
      {"guard_rail", Pattern::kPanels, 0.55F, 0.6F, 0.60F},
  };
  return materials;
}

const std::vector<std::string>& wall_materials() {
  static const std::vector<std::string> names = {"concrete_pale", "concrete_grey", "concrete_dark", "brick_red",
                                                 "brick_pale",    "panels_white",  "panels_blue",   "panels_green"};
  return names;
}

const std::vector<std::string>& sign_materials() {
  static const std::vector<std::string> names = {"sign_yellow", "sign_blue", "sign_white", "notice_board"};
  return names;
}

const std::vector<std::string>& vehicle_materials() {
  static const std::vector<std::string> names = {"car_white", "car_red", "car_grey", "car_black"};
  return names;
}

const std::vector<std::string>& car_paints() {
  static const std::vector<std::string> names = {"car_white", "car_red",  "car_grey",
                                                 "car_black", "car_blue", "car_silver"};
  return names;
}

const std::vector<std::string>& facade_materials() {
  static const std::vector<std::string> names = {"plaster_cream", "plaster_ochre", "plaster_rose",  "plaster_white",
                                                 "plaster_grey",  "facade_brick",  "facade_clinker"};
  return names;
}

const std::vector<std::string>& roof_materials() {
  static const std::vector<std::string> names = {"roof_tiles", "roof_slate", "roof_brown"};
  return names;
}

const std::vector<std::string>& cladding_materials() {
  static const std::vector<std::string> names = {"cladding_grey", "cladding_green", "cladding_red"};
  return names;
}

const std::vector<std::string>& crate_materials() {
  static const std::vector<std::string> names = {"crate_wood", "crate_board", "panels_grey"};
  return names;
}

const std::vector<std::string>& barrel_materials() {
  static const std::vector<std::string> names = {"barrel_blue", "barrel_orange", "steel"};
  return names;
}

const std::vector<std::string>& road_materials() {
  static const std::vector<std::string> names = {"asphalt", "asphalt_worn", "floor_screed"};
  return names;
}

const std::vector<std::string>& wood_materials() {
  static const std::vector<std::string> names = {"wood_pale", "wood_brown", "wood_dark"};
  return names;
}

const std::vector<std::string>& fabric_materials() {
  static const std::vector<std::string> names = {"carpet_red", "carpet_blue", "fabric_green", "fabric_grey"};
  return names;
}

const std::vector<std::string>& room_wall_materials() {
  static const std::vector<std::string> names = {"plaster", "concrete_pale", "brick_pale", "panels_white",
                                                 "panels_green"};
  return names;
}

const std::vector<std::string>& indoor_floor_materials() {
  static const std::vector<std::string> names = {"floor_screed", "floor_tiles", "floor_lino"};
  return names;
}

std::string pick(RandomStream& stream, const std::vector<std::string>& names) {
  return names[static_cast<std::size_t>(stream.integer(0, static_cast<int>(names.size()) - 1))];
}

std::string pick_other_than(const std::string& last, RandomStream& stream, const std::vector<std::string>& names) {
  std::string name = pick(stream, names);
  while (name == last) name = pick(stream, names);
  return name;
}

}  // namespace plumbline
