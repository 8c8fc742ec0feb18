#include "sim/world.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sim/mover_path.h"

namespace plumbline {
namespace {

// What a user's <light> becomes: MJCF has no photometric units, and set_light_level() scales all of it anyway.
constexpr double kUserLampIntensityCd = 400.0;
constexpr double kUserLampReachM = 15.0;
constexpr double kUserDirectionalLux = 300.0;
constexpr double kMoonlight_lux = 0.1;

Eigen::Vector3d vector_at(const mjtNum* values, int index) {
  return Eigen::Map<const Eigen::Matrix<mjtNum, 3, 1>>(values + 3 * index).cast<double>();
}

// Rec. 709 luminance.
double luminance(const float* rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

Material material_from_rgba(const std::string& name, const float* rgba) {
  Material material;
  material.name = name;
  material.albedo = static_cast<float>(std::clamp(luminance(rgba), 0.0, 1.0));
  material.lidar_reflectivity = material.albedo;
  return material;
}

std::string rgba_name(const float* rgba) {
  char name[64];
  std::snprintf(name, sizeof name, "rgba %.3f %.3f %.3f", static_cast<double>(rgba[0]), static_cast<double>(rgba[1]),
                static_cast<double>(rgba[2]));
  return name;
}

int index_of(const std::vector<Material>& materials, const std::string& name) {
  const auto found =
      std::find_if(materials.begin(), materials.end(), [&](const Material& m) { return m.name == name; });
  return found == materials.end() ? -1 : static_cast<int>(found - materials.begin());
}

std::vector<Material> materials_of_mjcf(const mjModel& model) {
  std::vector<Material> materials;
  for (int i = 0; i < model.nmat; ++i) {
    materials.push_back(material_from_rgba(mj_id2name(&model, mjOBJ_MATERIAL, i), model.mat_rgba + 4 * i));
  }
  return materials;
}

// Appends a material for every colour of the geoms that name none.
std::vector<int> assign_materials(const mjModel& model, std::vector<Material>& materials) {
  std::vector<int> material_of_geom;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const int mjcf_material = model.geom_matid[geom];
    const float* rgba = model.geom_rgba + 4 * geom;
    const std::string name = mjcf_material >= 0 ? mj_id2name(&model, mjOBJ_MATERIAL, mjcf_material) : rgba_name(rgba);
    int index = index_of(materials, name);
    if (index < 0 && mjcf_material >= 0) {
      throw std::invalid_argument("scene: a geom has material '" + name + "', which the scene does not describe");
    }
    if (index < 0) {
      index = static_cast<int>(materials.size());
      materials.push_back(material_from_rgba(name, rgba));
    }
    material_of_geom.push_back(index);
  }
  return material_of_geom;
}

void assign_mesh_materials(const mjModel& model, const std::vector<SceneMesh>& meshes,
                           const std::vector<Material>& materials, std::vector<int>& material_of_geom) {
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const int material = index_of(materials, meshes[i].material);
    if (material < 0) {
      throw std::invalid_argument("scene: mesh '" + meshes[i].name + "' has material '" + meshes[i].material +
                                  "', which the scene does not describe");
    }
    const int geom = mj_name2id(&model, mjOBJ_GEOM, mesh_geom_name(i).c_str());
    material_of_geom[static_cast<std::size_t>(geom)] = material;
  }
}

// A directional light is a lamp so far off that its light arrives almost parallel.
Lamp distant_lamp(const mjModel& model, const Eigen::Vector3d& direction, double strength) {
  const double distance = 4.0 * std::max(model.stat.extent, 1.0);
  Lamp lamp;
  lamp.position = vector_at(model.stat.center, 0) - distance * direction;
  lamp.intensity_cd = strength * kUserDirectionalLux * distance * distance;
  lamp.reach_m = 4.0 * distance;
  return lamp;
}

std::vector<Lamp> lamps_of_mjcf(const mjModel& model, const mjData& data) {
  std::vector<Lamp> lamps;
  for (int i = 0; i < model.nlight; ++i) {
    const double strength = luminance(model.light_diffuse + 3 * i);
    if (!model.light_active[i] || strength <= 0.0) continue;
    if (model.light_directional[i]) {
      lamps.push_back(distant_lamp(model, vector_at(data.light_xdir, i), strength));
    } else {
      lamps.push_back({vector_at(data.light_xpos, i), strength * kUserLampIntensityCd,
                       std::max(kUserLampReachM, model.stat.extent)});
    }
  }
  if (lamps.empty()) lamps.push_back(distant_lamp(model, -Eigen::Vector3d::UnitZ(), 1.0));
  return lamps;
}

double plate_illuminance(const std::vector<Lamp>& lamps, double ambient_lux, const Eigen::Vector3d& place) {
  double lux = ambient_lux;
  for (const Lamp& lamp : lamps) {
    const Eigen::Vector3d up_to_lamp = lamp.position - place;
    const double distance = up_to_lamp.norm();
    if (up_to_lamp.z() <= 0.0) continue;
    const double cosine = up_to_lamp.z() / distance;
    lux += lamp.intensity_cd * cosine / (distance * distance) * lamp_window(distance, lamp.reach_m);
  }
  return lux;
}

// The surfaces straight below each lamp and 2 m around it.
std::vector<Eigen::Vector3d> places_below(const std::vector<Lamp>& lamps, const mjModel& model, const mjData& data) {
  constexpr std::size_t kMaxLamps = 64;  // a user's meshes are slow to cast at
  constexpr double kOffsets[][2] = {{0, 0}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}};
  const mjtNum down[3] = {0, 0, -1};
  const std::size_t stride = lamps.size() / kMaxLamps + 1;
  std::vector<Eigen::Vector3d> places;
  for (std::size_t i = 0; i < lamps.size(); i += stride) {
    for (const auto& offset : kOffsets) {
      const Eigen::Vector3d start = lamps[i].position + Eigen::Vector3d(offset[0], offset[1], 0.0);
      int geom = -1;
      const double range = mj_ray(&model, &data, start.data(), down, nullptr, 1, -1, &geom);
      if (range > 0.0) places.push_back(start - range * Eigen::Vector3d::UnitZ());
    }
  }
  return places;
}

void check_lux(const char* what, double lux) {
  if (!std::isfinite(lux) || lux < 0.0) {
    throw std::invalid_argument(std::string(what) + ' ' + std::to_string(lux) +
                                " lux: must be finite and not negative");
  }
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// Equation (9) of B. Karis, "Real Shading in Unreal Engine 4" (2013): squared, so that its slope ends at zero, too.
double lamp_window(double distance_m, double reach_m) {
  const double ratio = distance_m / reach_m;
  const double window = std::clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
  return window * window;
}

World::World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::~World() = default;

World World::from_scene(const SceneDescription& scene, std::uint64_t world_seed) {
  World world;
  check_meshes(scene.meshes);
  const std::vector<SceneMesh> meshes = joined_meshes(scene.meshes, kMaxMeshes);
  world.model_ = compile_mjcf(scene.mjcf, meshes);
  world.data_ = forward_initial_state(*world.model_);
  world.rig_body_ = mj_name2id(world.model_.get(), mjOBJ_BODY, kRigBodyName);
  world.materials_ = scene.materials;
  world.material_of_geom_ = assign_materials(*world.model_, world.materials_);
  assign_mesh_materials(*world.model_, meshes, scene.materials, world.material_of_geom_);
  world.lamps_ = scene.lamps;
  world.ambient_lux_ = scene.ambient_lux;
  world.sun_ = scene.sun;
  world.sky_luminance_ = scene.sky_luminance;
  world.routes_ = scene.routes;
  world.set_movers(scene.movers);
  world.seed_ = world_seed;
  return world;
}

World World::from_mjcf_file(const std::filesystem::path& path, std::uint64_t world_seed) {
  World world;
  world.model_ = compile_mjcf_file(path);
  world.data_ = forward_initial_state(*world.model_);
  world.rig_body_ = mj_name2id(world.model_.get(), mjOBJ_BODY, kRigBodyName);
  world.materials_ = materials_of_mjcf(*world.model_);
  world.material_of_geom_ = assign_materials(*world.model_, world.materials_);
  world.lamps_ = lamps_of_mjcf(*world.model_, *world.data_);
  world.set_movers({});
  world.seed_ = world_seed;
  return world;
}

void World::set_movers(std::vector<Mover> movers) {
  movers_ = std::move(movers);
  mover_of_geom_.assign(static_cast<std::size_t>(model_->ngeom), -1);
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const int body = mj_name2id(model_.get(), mjOBJ_BODY, movers_[i].body.c_str());
    if (body < 0 || model_->body_mocapid[body] < 0) {
      throw std::invalid_argument("scene: mover '" + movers_[i].body + "' is not a mocap body of the scene");
    }
    mover_paths_.emplace_back(movers_[i]);
    for (int geom = 0; geom < model_->ngeom; ++geom) {
      if (model_->geom_bodyid[geom] == body) mover_of_geom_[static_cast<std::size_t>(geom)] = static_cast<int>(i);
    }
  }
}

Pose World::initial_pose_of_mover(std::size_t mover) const {
  const int body = mj_name2id(model_.get(), mjOBJ_BODY, movers_.at(mover).body.c_str());
  const mjtNum* q = data_->xquat + 4 * body;
  return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]), vector_at(data_->xpos, body)};
}

Pose World::pose_of_mover(std::size_t mover, double time_s) const { return mover_paths_.at(mover).at(time_s); }

void World::set_light_level(double lux) {
  check_lux("light level", lux);
  const double daylight = ambient_lux_ + sun_.lux * std::max(0.0, sun_.direction_to_sun.z());
  if (sun_.lux > 0.0 && daylight > 0.0) {
    const double factor = lux / daylight;
    ambient_lux_ *= factor;
    sun_.lux *= factor;
    sky_luminance_ *= factor;
    return;
  }
  std::vector<double> illuminances;
  for (const Eigen::Vector3d& place : places_below(lamps_, *model_, *data_)) {
    illuminances.push_back(plate_illuminance(lamps_, ambient_lux_, place));
  }
  const double level = illuminances.empty() ? ambient_lux_ : median(std::move(illuminances));
  if (level <= 0.0) {  // nothing shines: all the light there will be comes from everywhere
    ambient_lux_ = lux;
    return;
  }
  const double factor = lux / level;
  ambient_lux_ *= factor;
  for (Lamp& lamp : lamps_) lamp.intensity_cd *= factor;
}

Pose World::pose_of_geom(int geom) const {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(data_->geom_xmat + 9L * geom);
  return {Eigen::Quaterniond(rotation), Eigen::Map<const Eigen::Vector3d>(data_->geom_xpos + 3L * geom)};
}

void World::set_sun(double lux) {
  check_lux("sun", lux);
  sun_.lux = lux;
}

void World::make_night() {
  sun_.lux = 0.0;
  ambient_lux_ = std::min(ambient_lux_, kMoonlight_lux);
  // A sky that lights a horizontal plate with E has the luminance E / pi.
  sky_luminance_ = std::min(sky_luminance_, kMoonlight_lux / std::numbers::pi);
}

void World::scale_contrast(double factor) {
  for (Material& material : materials_) material.contrast *= static_cast<float>(factor);
}

}  // namespace plumbline
