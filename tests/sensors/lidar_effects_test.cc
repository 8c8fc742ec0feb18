// The errors of a lidar's returns against the configured model, as statistics: each check gives the probability of a
// deviation as large by chance, and the family of them is judged together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "sensors/lidar.h"
#include "sensors/lidar_noise.h"
#include "tools/verify/lidar_effects_check.h"
#include "tools/verify/lidar_stand.h"

namespace plumbline {
namespace {

LidarEffects only(bool LidarEffects::*effect) {
  LidarEffects effects = LidarEffects::none();
  effects.*effect = true;
  return effects;
}

TEST(LidarEffects, NoiseDropOutAndMixedPixelsAreThoseOfTheModel) {
  const std::map<std::string, double> chances = lidar_effect_chances();
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
  const LidarStand place(R"(<geom type="box" size="20 20 20"/><geom type="box" size="0.1 0.5 8" pos="6 0 0"/>)");
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
  LidarStand place(R"(<geom type="box" size="40 40 40"/>)");
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
    LidarStand place(R"(<geom type="box" size="0.1 0.1 0.1" pos="0 0 -50"/>)");
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
  const LidarStand place(R"(<geom type="box" size="4 3 2"/>)");
  // A roof rack 1 m ahead, in the vehicle's frame.
  World vehicle = World::from_scene(lidar_targets(R"(<geom type="box" size="0.1 0.5 0.5" pos="2.1 0 0.5"/>)", 0.5F), 1);
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
