#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/mjcf_model.h"

namespace plumbline {

/// How a surface looks to the camera and to the lidar. A geom names its material by MJCF's material="…".
struct Material {
  enum class Pattern { kPlain, kConcrete, kBrick, kPanels, kSigns, kAsphalt };
  std::string name;
  Pattern pattern = Pattern::kConcrete;
  float albedo = 0.5F;              ///< mean diffuse reflectance, visible light [0, 1]
  float contrast = 1.0F;            ///< 0: textureless, 1: the pattern's own contrast
  float lidar_reflectivity = 0.5F;  ///< at 905 nm [0, 1]
};

/// A point lamp that shines into all directions.
struct Lamp {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m], world
  double intensity_cd = 400.0;                         ///< luminous intensity [cd = lux m^2]
  double reach_m = 15.0;  ///< its light fades smoothly to nothing here, so that far lamps cost nothing
};

/// The smooth fading of a lamp's light towards its reach: 1 near by, 0 from reach_m on. A lamp's illuminance of a
/// surface is intensity_cd * cos(incidence) / distance^2 * lamp_window(distance, reach); nothing casts shadows.
double lamp_window(double distance_m, double reach_m);

/// All lamps and the ambient light are multiplied by `factor` from `start_s` on, until the next entry.
struct LightStep {
  double start_s = 0.0;
  double factor = 1.0;
};

/// What a procedural scene hands over. The MJCF holds geoms (and assets such as height fields and meshes) only.
struct SceneDescription {
  std::string mjcf;
  std::vector<Material> materials;
  std::vector<Lamp> lamps;
  double ambient_lux = 30.0;   ///< illuminance that every surface gets from everywhere
  double sky_luminance = 0.0;  ///< of rays that hit nothing [cd/m^2]
};

/// The simulated world: a compiled MuJoCo model with looks and lamps.
/// Every MJCF, procedural or a user's, gets a mocap body "plumbline_rig" that carries the sensors; it has no geoms.
class World {
 public:
  /// Geoms without material="…" look as their rgba says.
  /// @throws std::invalid_argument with MuJoCo's own message if the MJCF is rejected, or naming a geom's material that
  /// the scene does not describe.
  static World from_scene(const SceneDescription& scene, std::uint64_t world_seed);
  /// A user's MJCF. Materials follow its <material> and rgba (concrete of that luminance; its textures must load, but
  /// are not drawn), lamps its <light>s (or one overhead light without any).
  /// @throws std::invalid_argument naming the file if it is missing or MuJoCo rejects it or a mesh or texture it names.
  static World from_mjcf_file(const std::filesystem::path& path, std::uint64_t world_seed);

  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  const mjModel_& model() const { return *model_; }
  /// Poses of all geoms after mj_forward at the initial state.
  const mjData_& data() const { return *data_; }
  mjData_& data() { return *data_; }
  int rig_body() const { return rig_body_; }

  const std::vector<Material>& materials() const { return materials_; }
  /// Index into materials() of a geom.
  int material_of(int geom) const { return material_of_geom_.at(static_cast<std::size_t>(geom)); }
  const std::vector<Lamp>& lamps() const { return lamps_; }
  double ambient_lux() const { return ambient_lux_; }
  double sky_luminance() const { return sky_luminance_; }
  std::uint64_t seed() const { return seed_; }

  /// Scales lamps and ambient light so that a horizontal plate at the median lit place gets `lux`. The lit places are
  /// the surfaces below the lamps and 2 m around them.
  /// @throws std::invalid_argument unless lux is finite and not negative.
  void set_light_level(double lux);

 private:
  World() = default;

  MjModelPtr model_;
  MjDataPtr data_;
  int rig_body_ = -1;
  std::vector<Material> materials_;
  std::vector<int> material_of_geom_;
  std::vector<Lamp> lamps_;
  double ambient_lux_ = 30.0;
  double sky_luminance_ = 0.0;
  std::uint64_t seed_ = 0;
};

}  // namespace plumbline
