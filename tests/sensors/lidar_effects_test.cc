// The errors of a lidar's returns against the configured model, as statistics: each check gives the probability of a
// deviation as large by chance, and the family of them is judged together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "sensors/lidar.h"
#include "sensors/lidar_noise.h"

namespace plumbline {
namespace {

constexpr double kPi = std::numbers::pi;

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

SceneDescription scene_of(const std::string& geoms, float reflectivity) {
  SceneDescription scene;
  scene.mjcf =
      "<mujoco><asset><material name=\"wall\"/></asset><default><geom material=\"wall\"/></default><worldbody>" +
      geoms + "</worldbody></mujoco>";
  Material wall;
  wall.name = "wall";
  wall.lidar_reflectivity = reflectivity;
  scene.materials = {wall};
  return scene;
}

struct Place {
  World world;
  RayScene rays;
  PoseTrack at_rest;

  explicit Place(const std::string& geoms, float reflectivity = 0.5F)
      : world(World::from_scene(scene_of(geoms, reflectivity), 1)), rays(world) {
    at_rest.push(0, Pose{});
    at_rest.push(100'000'000'000, Pose{});
  }
  LidarScan scan(const Lidar& lidar, std::int64_t message = 0, const OwnBody* own_body = nullptr) const {
    return lidar.scan({world, rays, own_body}, at_rest, message * lidar.period_ns(), message);
  }
};

LidarEffects only(bool LidarEffects::*effect) {
  LidarEffects effects = LidarEffects::none();
  effects.*effect = true;
  return effects;
}

// A floor below, seen by one beam: every firing has the same range and the same angle of incidence.
struct Floor {
  double range_m;
  double incidence_deg;
  float reflectivity;

  std::string geom() const {
    return "<geom type=\"plane\" size=\"0 0 1\" pos=\"0 0 " + std::to_string(-height_m()) + "\"/>";
  }
  double height_m() const { return range_m * std::cos(incidence_deg * kPi / 180.0); }
};

LidarModel one_beam(const Floor& floor) {
  LidarModel model = vlp16();
  model.beams = {{.elevation_deg = floor.incidence_deg - 90.0}};
  model.head = SpinningHead{5e-6};
  model.encoder_resolution_deg = 0.0;
  model.max_range_m = 200.0;
  return model;
}

/// The chance of a chi^2 as large, by Wilson and Hilferty's cube root.
double chance_of_chi_squared(double chi_squared, double degrees) {
  const double spread = 2.0 / (9.0 * degrees);
  return normal_cdf((1.0 - spread - std::cbrt(chi_squared / degrees)) / std::sqrt(spread));
}

struct Cell {
  double expected = 0.0;
  double observed = 0.0;
};

/// Neighbouring cells are joined until at least 20 are expected in each.
double chance_of(const std::vector<Cell>& cells, bool total_is_fixed) {
  double chi_squared = 0.0;
  int count = 0;
  Cell joined;
  std::vector<Cell> large;
  for (const Cell& cell : cells) {
    joined.expected += cell.expected;
    joined.observed += cell.observed;
    if (joined.expected < 20.0) continue;
    large.push_back(joined);
    joined = {};
  }
  large.back().expected += joined.expected;
  large.back().observed += joined.observed;
  for (const Cell& cell : large) {
    chi_squared += std::pow(cell.observed - cell.expected, 2) / cell.expected;
    ++count;
  }
  return chance_of_chi_squared(chi_squared, count - (total_is_fixed ? 1 : 0));
}

/// Ranges in steps of the resolution, against a normal distribution rounded to it.
double chance_of_range_noise(const Floor& floor) {
  LidarModel model = one_beam(floor);
  LidarEffects effects = only(&LidarEffects::range_noise);
  effects.quantisation = true;
  const double sigma_m =
      expected_range_sigma_m(model, floor.range_m, floor.reflectivity, floor.incidence_deg * kPi / 180);
  const LidarScan scan = Place(floor.geom(), floor.reflectivity).scan(Lidar(model, Pose{}, 11, effects));
  const double step_m = model.range_resolution_m;
  std::map<std::int64_t, double> count;
  for (const LidarPoint& point : scan.points) ++count[std::llround(point.position.cast<double>().norm() / step_m)];
  std::vector<Cell> cells;
  const auto middle = std::llround(floor.range_m / step_m);
  const auto reach = static_cast<std::int64_t>(8.0 * sigma_m / step_m) + 2;
  const auto below = [&](double steps) { return normal_cdf((steps * step_m - floor.range_m) / sigma_m); };
  for (std::int64_t k = middle - reach; k <= middle + reach; ++k) {
    const double share = below(static_cast<double>(k) + 0.5) - below(static_cast<double>(k) - 0.5);
    cells.push_back({share * static_cast<double>(scan.points.size()), count[k]});
  }
  return chance_of(cells, true);
}

/// Returns among the firings, around where the device begins to lose them.
double chance_of_drop_out() {
  double chi_squared = 0.0;
  int count = 0;
  for (const double incidence_deg : {0.0, 40.0, 75.0}) {
    for (const double share_of_limit : {0.85, 0.95, 1.0, 1.05, 1.15}) {
      Floor floor{0.0, incidence_deg, 0.3F};
      LidarModel model = one_beam(floor);
      model.beams[0].elevation_deg = std::max(-89.9, model.beams[0].elevation_deg);
      const double incidence = (model.beams[0].elevation_deg + 90.0) * kPi / 180.0;
      floor.incidence_deg = model.beams[0].elevation_deg + 90.0;
      floor.range_m = share_of_limit * model.range_at_10_percent_m * std::sqrt(3.0 * std::cos(incidence));
      const LidarScan scan =
          Place(floor.geom(), floor.reflectivity).scan(Lidar(model, Pose{}, 5, only(&LidarEffects::drop_out)), count);
      const double firings = 20000.0;
      const double share = expected_return_share(model, floor.range_m, floor.reflectivity, incidence);
      const double variance = firings * share * (1.0 - share);
      chi_squared += std::pow(static_cast<double>(scan.points.size()) - firings * share, 2) / variance;
      ++count;
    }
  }
  return chance_of_chi_squared(chi_squared, count);
}

// Slats 8 m away before a wall 8.3 m away, all around: at their edges the two merge into ranges between them. How far
// in between follows from the Gaussian's share on the slat, so a class of it belongs to a band of widths at the edge.
double chance_of_mixed_pixels() {
  constexpr double kNear_m = 8.0;
  constexpr double kFar_m = 8.3;
  constexpr int kSlats = 20;
  constexpr int kScans = 10;
  std::ostringstream geoms;
  geoms << "<geom type=\"cylinder\" size=\"" << kFar_m << " 20\"/>";
  for (int i = 0; i < kSlats; ++i) {
    const double azimuth = 2.0 * kPi * i / kSlats;
    geoms << "<geom type=\"box\" size=\"0.001 0.15 5\" pos=\"" << (kNear_m + 0.001) * std::cos(azimuth) << ' '
          << (kNear_m + 0.001) * std::sin(azimuth) << " 0\" euler=\"0 0 " << azimuth * 180.0 / kPi << "\"/>";
  }
  const Place place(geoms.str());
  LidarModel model = vlp16();
  for (LidarBeam& beam : model.beams) beam.vertical_offset_m = 0.0;
  const Lidar lidar(model, Pose{}, 3, only(&LidarEffects::mixed_pixels));
  // In shares of the energy on the slat, halfway between what the sub-rays can give.
  std::vector<double> limits;
  for (const double rays : {1.5, 3.5, 5.5, 6.5, 8.5, 10.5}) limits.push_back(rays / LidarFootprint::kRays);
  std::vector<Cell> cells(limits.size() - 1);
  // Edges are 0.15 m from the slat's middle, so a little farther away.
  const double edge_m = std::hypot(kNear_m, 0.15);
  for (int scan = 0; scan < kScans; ++scan) {
    for (const LidarPoint& point : place.scan(lidar, scan).points) {
      const double range_m = std::hypot(point.position.x(), point.position.y());
      // The range is the mean weighted by signals, which go with 1 / range^2.
      const double slat = (kFar_m - range_m) * edge_m * edge_m;
      const double wall = (range_m - edge_m) * kFar_m * kFar_m;
      const double share = slat / (slat + wall);
      for (std::size_t c = 0; c < cells.size(); ++c)
        if (share >= limits[c] && share < limits[c + 1]) ++cells[c].observed;
    }
  }
  const double step_m = edge_m * 2.0 * kPi * 55.296e-6 * model.rate_hz;  // between a beam's firings
  for (const LidarBeam& beam : model.beams) {
    const double range_m = edge_m / std::cos(beam.elevation_deg * kPi / 180.0);
    const double half_width_m = 0.5 * (model.exit_width_m + model.divergence_horizontal_rad * range_m);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const double band_m = 0.5 * half_width_m * (gaussian_quantile(limits[c + 1]) - gaussian_quantile(limits[c]));
      cells[c].expected += 2.0 * kSlats * kScans * band_m / step_m;
    }
  }
  return chance_of(cells, false);
}

TEST(LidarEffects, NoiseDropOutAndMixedPixelsAreThoseOfTheModel) {
  const std::map<std::string, double> chances = {{"noise near and square", chance_of_range_noise({3.0, 10.0, 0.5F})},
                                                 {"noise far", chance_of_range_noise({40.0, 10.0, 0.5F})},
                                                 {"noise oblique", chance_of_range_noise({10.0, 75.0, 0.5F})},
                                                 {"noise dark", chance_of_range_noise({15.0, 10.0, 0.05F})},
                                                 {"drop-out", chance_of_drop_out()},
                                                 {"mixed pixels", chance_of_mixed_pixels()}};
  // Bonferroni: with as many checks, one of them falls below this by chance once in a hundred times.
  for (const auto& [check, chance] : chances) {
    EXPECT_GE(chance, 0.01 / static_cast<double>(chances.size())) << check;
  }
}

TEST(LidarEffects, TheQuantileIsTheInverseOfTheDistribution) {
  for (const double x : {-6.0, -3.5, -1.5, -0.3, 0.0, 0.7, 2.2, 4.0})
    EXPECT_NEAR(gaussian_quantile(normal_cdf(x)), x, 1e-5);
}

TEST(LidarEffects, EchoesWithinAPulseMergeByTheirStrength) {
  LidarEchoes echoes;
  echoes.add({10.0, 1.0, 0.0});
  echoes.add({12.0, 5.0, 0.0});
  echoes.add({10.6, 2.0, 0.0});
  echoes.merge(0.75);
  ASSERT_EQ(echoes.size(), 2U);
  EXPECT_NEAR(echoes[0].range_m, 10.4, 1e-12);
  EXPECT_NEAR(echoes[0].strength, 3.0, 1e-12);
  EXPECT_NEAR(echoes[0].spread_m, std::sqrt(2.0 / 9.0 * 0.36), 1e-12);
  EXPECT_EQ(echoes[1].range_m, 12.0);
}

// Edges more than a pulse apart: one of the two, or both.
TEST(LidarEffects, AnEdgeFarBeforeAWallGivesTwoReturnsToThoseWhoAsk) {
  const Place place(R"(<geom type="box" size="20 20 20"/><geom type="box" size="0.1 0.5 8" pos="6 0 0"/>)");
  const LidarEffects effects = only(&LidarEffects::mixed_pixels);
  const LidarScan single = place.scan(Lidar(vlp16(), Pose{}, 1, effects));
  const LidarScan last = place.scan(Lidar(vlp16(), Pose{}, 1, effects, LidarReturns::kLast));
  const LidarScan dual = place.scan(Lidar(vlp16(), Pose{}, 1, effects, LidarReturns::kDual));
  EXPECT_EQ(last.points.size(), single.points.size());
  ASSERT_GT(dual.points.size(), single.points.size());
  std::size_t pairs = 0;
  for (std::size_t i = 0; i + 1 < dual.points.size(); ++i) {
    if (dual.points[i].offset_ns != dual.points[i + 1].offset_ns || dual.points[i].ring != dual.points[i + 1].ring)
      continue;
    ++pairs;
    EXPECT_GT(std::abs(dual.points[i].position.norm() - dual.points[i + 1].position.norm()), 0.7F);
  }
  EXPECT_EQ(pairs, dual.points.size() - single.points.size());
  const auto total_range = [](const LidarScan& scan) {
    double sum = 0.0;
    for (const LidarPoint& point : scan.points) sum += double{point.position.norm()};
    return sum;
  };
  EXPECT_GT(total_range(last), total_range(single));
}

TEST(LidarEffects, FogTakesFarSurfacesAndGivesNearReturns) {
  Place place(R"(<geom type="box" size="40 40 40"/>)");
  const Lidar lidar(vlp16(), Pose{}, 1, [] {
    LidarEffects effects;
    effects.mixed_pixels = false;
    return effects;
  }());
  const std::size_t clear = place.scan(lidar).points.size();
  place.world.atmosphere.fog_visibility_m = 30.0;
  const LidarScan foggy = place.scan(lidar);
  const auto from_air = std::count_if(foggy.points.begin(), foggy.points.end(),
                                      [](const LidarPoint& point) { return point.position.norm() < 30.0F; });
  const auto from_walls = static_cast<std::ptrdiff_t>(foggy.points.size()) - from_air;
  EXPECT_GT(clear, 28000U);
  EXPECT_EQ(from_walls, 0) << "30 m of visibility leave nothing of 80 m of way";
  EXPECT_GT(from_air, 1000);
}

TEST(LidarEffects, RainAndDustGiveAFewNearReturnsOfTheOpenSky) {
  const auto returns_of = [](const Atmosphere& atmosphere) {
    Place place(R"(<geom type="box" size="0.1 0.1 0.1" pos="0 0 -50"/>)");
    place.world.atmosphere = atmosphere;
    const LidarScan scan = place.scan(Lidar(vlp16(), Pose{}, 1));
    for (const LidarPoint& point : scan.points) EXPECT_LT(point.position.norm(), 40.0F);
    return scan.points.size();
  };
  Atmosphere drizzle;
  drizzle.rain_mm_per_h = 2.0;
  Atmosphere downpour;
  downpour.rain_mm_per_h = 40.0;
  Atmosphere dust;
  dust.dust_visibility_m = 50.0;
  EXPECT_EQ(returns_of({}), 0U);
  EXPECT_GT(returns_of(downpour), returns_of(drizzle));
  EXPECT_LT(returns_of(downpour), 15000U);
  EXPECT_GT(returns_of(dust), 500U);
}

TEST(LidarEffects, TheVehicleHidesWhatIsBehindIt) {
  const Place place(R"(<geom type="box" size="4 3 2"/>)");
  // A roof rack 1 m ahead, in the vehicle's frame.
  World vehicle = World::from_scene(scene_of(R"(<geom type="box" size="0.1 0.5 0.5" pos="2.1 0 0.5"/>)", 0.5F), 1);
  RayScene vehicle_rays(vehicle);
  const OwnBody own_body{std::move(vehicle), std::move(vehicle_rays),
                         Pose{Eigen::Quaterniond::Identity(), {-1, 0, -0.5}}};
  const auto within_rack = [&](const LidarEffects& effects) {
    const LidarScan scan = place.scan(Lidar(vlp16(), Pose{}, 1, effects), 0, &own_body);
    return std::count_if(scan.points.begin(), scan.points.end(), [](const LidarPoint& point) {
      return std::abs(point.position.x() - 1.0F) < 1e-3F && std::abs(point.position.y()) < 0.51F;
    });
  };
  EXPECT_GT(within_rack(only(&LidarEffects::own_body)), 1000);
  EXPECT_EQ(within_rack(LidarEffects::none()), 0);
}

}  // namespace
}  // namespace plumbline
