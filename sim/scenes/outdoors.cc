#include "sim/scenes/outdoors.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/scenes/palette.h"
#include "sim/scenes/ribbon.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Sun draw_sun(std::uint64_t seed) {
  RandomStream stream(seed, "outdoors/sun");
  const double azimuth = stream.uniform(0.0, 2.0 * std::numbers::pi);
  const double elevation = stream.uniform(25.0, 60.0) * std::numbers::pi / 180.0;
  Sun sun;
  sun.direction_to_sun = {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                          std::sin(elevation)};
  sun.lux = stream.uniform(30000.0, 60000.0);
  return sun;
}

/// The land's height and how far the line is, from the line's places every 20 m.
class FarLand {
 public:
  FarLand(const RoadLine& line, double half_width_m, std::uint64_t seed, const std::function<double(double)>& sunk)
      : half_width_(half_width_m), seed_(seed) {
    for (double s = 0.0; s <= line.length(); s += 20.0) {
      Vector3d place = line.at(s);
      place.z() -= sunk(s);
      places_.push_back(place);
    }
  }

  double distance(const Vector2d& point) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector3d& place : places_) nearest = std::min(nearest, (place.head<2>() - point).squaredNorm());
    return std::sqrt(nearest);
  }

  double height(const Vector2d& point) const {
    double sum = 0.0;
    double weights = 0.0;
    for (const Vector3d& place : places_) {
      const double near = (place.head<2>() - point).squaredNorm() + 200.0;
      const double weight = 1.0 / (near * near);
      sum += weight * place.z();
      weights += weight;
    }
    const double away = std::clamp((distance(point) - half_width_ - 30.0) / 180.0, 0.0, 1.0);
    const double hills = 14.0 + 22.0 * smooth_noise(seed_, point.x() / 170.0, point.y() / 170.0);
    return sum / weights - 5.0 + away * away * hills;
  }

 private:
  double half_width_;
  std::uint64_t seed_;
  std::vector<Vector3d> places_;
};

void add_far_woods(Scenery& scenery, RandomStream& stream, const Vector3d& foot) {
  const double height = stream.uniform(7.0, 14.0);
  const double radius = stream.uniform(0.3, 0.5) * height;
  scenery.rod(stream.uniform() < 0.5 ? "foliage_dark" : "foliage_green", foot - Vector3d(0.0, 0.0, 2.0),
              foot + Vector3d(0.0, 0.0, height), radius, 0.2, 5);
}

/// Corner heights of a ground's cells, row by row.
struct HeightGrid {
  int columns = 0;
  int rows = 0;
  std::vector<double> z;
  double at(int column, int row) const {
    return z[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns + 1) + static_cast<std::size_t>(column)];
  }
};

HeightGrid sample_heights(const Terrain& ground) {
  HeightGrid grid;
  grid.columns = static_cast<int>(std::lround((ground.high.x() - ground.low.x()) / ground.cell_m));
  grid.rows = static_cast<int>(std::lround((ground.high.y() - ground.low.y()) / ground.cell_m));
  for (int row = 0; row <= grid.rows; ++row) {
    for (int column = 0; column <= grid.columns; ++column) {
      grid.z.push_back(ground.height(ground.low.x() + column * ground.cell_m, ground.low.y() + row * ground.cell_m));
    }
  }
  return grid;
}

}  // namespace

SceneParameter night_parameter() { return {"night", 0, 0, 1, "0: daylight, 1: night, lit by lamps", true}; }

SceneDescription finish_outdoors(const std::string& name, Outdoors outdoors, bool night, std::uint64_t world_seed) {
  for (SceneMesh& mesh : outdoors.scenery.take_meshes()) outdoors.geoms.mesh(std::move(mesh));
  RandomStream stream(world_seed, "outdoors/sky");
  // A surface that faces a uniform sky of luminance L gets pi L from it.
  const double ambient_lux = night ? 0.3 : stream.uniform(8000.0, 14000.0);
  SceneDescription scene = outdoors.geoms.finish(name, scene_palette(), ambient_lux, ambient_lux / std::numbers::pi);
  if (night) {
    scene.sun.lux = 0.0;
  } else {
    scene.sun = draw_sun(world_seed);
    scene.lamps.clear();
  }
  scene.routes = std::move(outdoors.routes);
  scene.movers = std::move(outdoors.movers);
  return scene;
}

void add_far_land(Scenery& scenery, const RoadLine& line, double half_width_m, std::uint64_t seed,
                  const std::function<double(double s)>& sunk) {
  constexpr double kCell_m = 40.0;
  constexpr double kMargin_m = 280.0;
  const std::uint64_t land_seed = derive_seed(seed, "outdoors/far land");
  const FarLand land(line, half_width_m, land_seed, sunk);
  Eigen::AlignedBox2d box;
  for (double s = 0.0; s <= line.length(); s += 10.0) box.extend(Vector2d(line.at(s).head<2>()));
  const Eigen::Vector2i low = ((box.min().array() - kMargin_m) / kCell_m).floor().cast<int>();
  const Eigen::Vector2i high = ((box.max().array() + kMargin_m) / kCell_m).ceil().cast<int>();
  const int columns = high.x() - low.x();
  const auto corner_of = [&](int column, int row) { return Vector2d(column * kCell_m, row * kCell_m); };
  std::vector<Vector3d> corners;
  for (int row = low.y(); row <= high.y(); ++row) {
    for (int column = low.x(); column <= high.x(); ++column) {
      const Vector2d place = corner_of(column, row);
      corners.emplace_back(place.x(), place.y(), land.height(place));
    }
  }
  const auto corner = [&](int column, int row) {
    return corners[static_cast<std::size_t>((row - low.y()) * (columns + 1) + column - low.x())];
  };
  const std::string covers[] = {"grass", "grass_dry", "field", "grass"};
  for (int row = low.y(); row < high.y(); ++row) {
    for (int column = low.x(); column < high.x(); ++column) {
      const double distance = land.distance(corner_of(column, row));
      if (distance > kMargin_m + half_width_m) continue;
      const auto place = static_cast<std::uint64_t>(static_cast<std::uint32_t>(column / 2 * 7919 + row / 3));
      const std::string& cover = covers[mix_bits(land_seed ^ place) % 4];
      scenery.quad(cover, corner(column, row), corner(column + 1, row), corner(column + 1, row + 1),
                   corner(column, row + 1));
      const bool wooded = smooth_noise(land_seed + 1, column * 0.35, row * 0.35) > 0.05;
      if (!wooded || distance < half_width_m + 1.5 * kCell_m) continue;
      RandomStream stream(land_seed, "woods/" + std::to_string(column) + "/" + std::to_string(row));
      for (int i = 0; i < 5; ++i) {
        const double u = stream.uniform();
        const double v = stream.uniform();
        const Vector3d along = corner(column, row) + u * (corner(column + 1, row) - corner(column, row));
        const Vector3d across = corner(column, row + 1) + u * (corner(column + 1, row + 1) - corner(column, row + 1));
        add_far_woods(scenery, stream, along + v * (across - along));
      }
    }
  }
}

void add_ground(Scenery& scenery, const Terrain& ground) {
  const HeightGrid grid = sample_heights(ground);
  const double base = *std::min_element(grid.z.begin(), grid.z.end()) - 3.0;
  const auto place = [&](int column, int row) {
    return Vector3d(ground.low.x() + column * ground.cell_m, ground.low.y() + row * ground.cell_m,
                    grid.at(column, row));
  };
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const Vector3d a = place(column, row);
      const std::string material = ground.material(a.x() + 0.5 * ground.cell_m, a.y() + 0.5 * ground.cell_m);
      if (material.empty()) continue;
      scenery.quad(material, a, place(column + 1, row), place(column + 1, row + 1), place(column, row + 1));
    }
  }
  const auto skirt = [&](const Vector3d& a, const Vector3d& b) {
    scenery.quad("field", {a.x(), a.y(), base}, {b.x(), b.y(), base}, b, a);
  };
  for (int column = 0; column < grid.columns; ++column) {
    skirt(place(column, 0), place(column + 1, 0));
    skirt(place(column + 1, grid.rows), place(column, grid.rows));
  }
  for (int row = 0; row < grid.rows; ++row) {
    skirt(place(grid.columns, row), place(grid.columns, row + 1));
    skirt(place(0, row + 1), place(0, row));
  }
}

double height_on(const Terrain& ground, double x, double y) {
  const double u = (x - ground.low.x()) / ground.cell_m;
  const double v = (y - ground.low.y()) / ground.cell_m;
  const double column = std::floor(u);
  const double row = std::floor(v);
  const auto corner = [&](double i, double j) {
    return ground.height(ground.low.x() + (column + i) * ground.cell_m, ground.low.y() + (row + j) * ground.cell_m);
  };
  const double du = u - column;
  const double dv = v - row;
  const double a = corner(0.0, 0.0);
  const double c = corner(1.0, 1.0);
  // Quads are split from the lower left to the upper right corner.
  if (du >= dv) {
    const double b = corner(1.0, 0.0);
    return a + du * (b - a) + dv * (c - b);
  }
  const double d = corner(0.0, 1.0);
  return a + dv * (d - a) + du * (c - d);
}

}  // namespace plumbline
