#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/mjcf_model.h"
#include "sim/scene_mesh.h"

namespace plumbline {

/// How a surface looks to the camera and to the lidar. A geom names its material by MJCF's material="…".
struct Material {
  enum class Pattern {
    kPlain,
    kConcrete,
    kBrick,
    kPanels,
    kSigns,
    kAsphalt,
    kFacade,  ///< rows of windows
    kGrass,
    kFoliage,
    kGravel,
    kWood,
    kFabric,            ///< carpet, upholstery
    kStripesVertical,   ///< edges that tell a camera where it is along the wall, but not how high
    kStripesHorizontal  ///< and the other way round
  };
  std::string name;
  Pattern pattern = Pattern::kConcrete;
  float albedo = 0.5F;                             ///< mean diffuse reflectance, visible light [0, 1]
  float contrast = 1.0F;                           ///< 0: textureless, 1: the pattern's own contrast
  float lidar_reflectivity = 0.5F;                 ///< at 905 nm [0, 1]
  Eigen::Vector3f tint = Eigen::Vector3f::Ones();  ///< colour: linear red, green, blue, each a factor on the albedo
  bool two_sided = false;                          ///< drawn from behind, too: leaves, not walls (rays see both sides)
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

/// Parallel light.
struct Sun {
  Eigen::Vector3d direction_to_sun = Eigen::Vector3d::UnitZ();  ///< unit, world
  double lux = 0.0;                                             ///< on a surface that faces it; 0: no sun
};

/// What is in the air. Visibility is the distance at which contrast falls to 2 % (Koschmieder: extinction = 3.912 / V).
struct Atmosphere {
  double fog_visibility_m = std::numeric_limits<double>::infinity();
  double dust_visibility_m = std::numeric_limits<double>::infinity();  ///< coarse grains: single returns to a lidar
  double rain_mm_per_h = 0.0;
};

/// A way through a scene that a vehicle or walker can take.
struct Route {
  std::string name;
  std::vector<Eigen::Vector3d> points;  ///< on the ground, or in the air where flown; neighbours 0.5 m to 20 m apart
  bool closed = false;                  ///< the last point leads to the first
  bool flown = false;                   ///< in the air
};

/// A body of the scene's MJCF (mocap="true", child of the world, its geoms about its origin, x forward) that drives
/// along a path at constant speed for ever: to the end and again from the start, or round and round.
struct Mover {
  std::string body;
  Route path;
  double speed_mps = 0.0;
  double start_m = 0.0;  ///< where on the path it is at time 0
};

/// What a procedural scene hands over. The MJCF holds geoms (and assets such as height fields and meshes) only.
struct SceneDescription {
  std::string mjcf;
  std::vector<SceneMesh> meshes;
  std::vector<Material> materials;
  std::vector<Lamp> lamps;
  Sun sun;
  double ambient_lux = 30.0;   ///< illuminance that every surface gets from everywhere
  double sky_luminance = 0.0;  ///< of rays that hit nothing [cd/m^2]
  std::vector<Route> routes;   ///< the first is the scene's own tour
  std::vector<Mover> movers;
};

class MoverPath;

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
  /// world_from_geom after mj_forward at the initial state.
  Pose pose_of_geom(int geom) const;

  const std::vector<Material>& materials() const { return materials_; }
  /// Index into materials() of a geom.
  int material_of(int geom) const { return material_of_geom_.at(static_cast<std::size_t>(geom)); }
  const std::vector<Lamp>& lamps() const { return lamps_; }
  double ambient_lux() const { return ambient_lux_; }
  const Sun& sun() const { return sun_; }
  double sky_luminance() const { return sky_luminance_; }
  const std::vector<Route>& routes() const { return routes_; }
  const std::vector<Mover>& movers() const { return movers_; }
  /// Index into movers() of the mover that a geom belongs to, or -1 for what stands still.
  int mover_of(int geom) const { return mover_of_geom_.at(static_cast<std::size_t>(geom)); }
  int geom_count() const { return static_cast<int>(material_of_geom_.size()); }
  /// Where the body of a mover stands in data(), as its geoms do.
  Pose initial_pose_of_mover(std::size_t mover) const;
  /// world_from_body of a mover, x along its path.
  Pose pose_of_mover(std::size_t mover, double time_s) const;

  Atmosphere atmosphere;     ///< of the whole world; clear unless a scenario says otherwise
  double rig_lamp_cd = 0.0;  ///< luminous intensity of a lamp on the rig, at the camera, shining ahead
  std::uint64_t seed() const { return seed_; }

  /// Scales the light so that a horizontal plate at the median lit place gets `lux`. By day, with a sun in the sky, the
  /// lit places are those under it, and sun, ambient light and sky are scaled. Otherwise they are the surfaces below
  /// the lamps and 2 m around them, and lamps and ambient light are.
  /// @throws std::invalid_argument unless lux is finite and not negative.
  void set_light_level(double lux);
  /// On a surface that faces the sun; 0 switches it off. @throws std::invalid_argument as set_light_level.
  void set_sun(double lux);
  /// No sun, and a sky as under a full moon; lamps stay.
  void make_night();
  /// Multiplies every material's contrast: 0 leaves nothing to track on surfaces.
  void scale_contrast(double factor);
  void add_lamp(const Lamp& lamp) { lamps_.push_back(lamp); }

 private:
  World();
  void set_movers(std::vector<Mover> movers);

  MjModelPtr model_;
  MjDataPtr data_;
  int rig_body_ = -1;
  std::vector<Material> materials_;
  std::vector<int> material_of_geom_;
  std::vector<Lamp> lamps_;
  Sun sun_;
  double ambient_lux_ = 30.0;
  double sky_luminance_ = 0.0;
  std::vector<Route> routes_;
  std::vector<Mover> movers_;
  std::vector<MoverPath> mover_paths_;
  std::vector<int> mover_of_geom_;
  std::uint64_t seed_ = 0;
};

}  // namespace plumbline
