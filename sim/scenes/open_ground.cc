#include "sim/scenes/open_ground.h"

#include "sim/scenes/palette.h"
#include "sim/scenes/walls.h"

namespace plumbline {

namespace {
constexpr double kThickM = 1.0;
}

void add_patches(MjcfWriter& writer, RandomStream& stream, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                 const std::vector<std::string>& materials) {
  const std::vector<double> rows = random_cuts(stream, low.y(), high.y(), 8.0, 16.0);
  std::string material;
  for (std::size_t j = 1; j < rows.size(); ++j) {
    const std::vector<double> cuts = random_cuts(stream, low.x(), high.x(), 8.0, 16.0);
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      material = pick_other_than(material, stream, materials);
      writer.box(material, {cuts[i - 1], rows[j - 1], -kThickM}, {cuts[i], rows[j], 0.0});
    }
  }
}

void add_open_ground(MjcfWriter& writer, RandomStream& stream, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                     const std::vector<std::string>& materials, double reach_m) {
  add_patches(writer, stream, low, high, materials);
  const std::string& far = materials.front();
  writer.box(far, {-reach_m, -reach_m, -kThickM}, {reach_m, low.y(), 0.0});
  writer.box(far, {-reach_m, high.y(), -kThickM}, {reach_m, reach_m, 0.0});
  writer.box(far, {-reach_m, low.y(), -kThickM}, {low.x(), high.y(), 0.0});
  writer.box(far, {high.x(), low.y(), -kThickM}, {reach_m, high.y(), 0.0});
}

void light_by_day(SceneDescription& scene) {
  scene.sun.direction_to_sun = Eigen::Vector3d(0.45, -0.6, 0.66).normalized();
  scene.sun.lux = 60'000.0;
  scene.ambient_lux = 20'000.0;
  scene.sky_luminance = 5'000.0;
}

}  // namespace plumbline
