#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/ray_scene.h"
#include "sim/scene_library.h"
#include "sim/scenes/routes.h"
#include "sim/world.h"

namespace plumbline {
namespace {

constexpr double kEye_m = 1.5;
constexpr double kLidarReach_m = 30.0;

class CompositeLoop : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  CompositeLoop()
      : world_(World::from_scene(build_scene("composite_loop", {}, GetParam()), GetParam())), rays_(world_) {}

  const Route& loop() const { return world_.routes().front(); }

  Eigen::Vector3d place_near(double x, double y) const {
    const Eigen::Vector2d wanted(x, y);
    return *std::min_element(loop().points.begin(), loop().points.end(), [&](const auto& a, const auto& b) {
      return (a.template head<2>() - wanted).norm() < (b.template head<2>() - wanted).norm();
    });
  }

  /// Normals of what a lidar of 30 m, 30 degrees high, sees from a place.
  std::vector<Eigen::Vector3d> normals_seen_from(const Eigen::Vector3d& place) const {
    std::vector<Eigen::Vector3d> normals;
    for (int i = 0; i < 360; ++i) {
      for (double elevation = -15.0; elevation <= 15.0; elevation += 2.0) {
        const double azimuth = i * M_PI / 180.0;
        const double pitch = elevation * M_PI / 180.0;
        const Eigen::Vector3d direction(std::cos(azimuth) * std::cos(pitch), std::sin(azimuth) * std::cos(pitch),
                                        std::sin(pitch));
        const RayHit hit = rays_.cast(place + kEye_m * Eigen::Vector3d::UnitZ(), direction, 0.0, kLidarReach_m);
        if (hit.hit) normals.push_back(hit.normal_in_world.cast<double>());
      }
    }
    return normals;
  }

  /// On a surface that faces the nearest lamps, without what walls would hide.
  double lamplight_at(const Eigen::Vector3d& place) const {
    double lux = 0.0;
    for (const Lamp& lamp : world_.lamps()) {
      const double distance = (lamp.position - place).norm();
      lux += lamp.intensity_cd * lamp_window(distance, lamp.reach_m) / (distance * distance);
    }
    return lux;
  }

  World world_;
  RayScene rays_;
};

TEST_P(CompositeLoop, IsAsLongAsTheThesisSays) {
  EXPECT_TRUE(loop().closed);
  EXPECT_NEAR(length_of(loop()), 538.0, 2.0);
}

TEST_P(CompositeLoop, TheOpenGroundShowsALidarNothingElse) {
  for (const auto& [x, y] : {std::pair{-73.0, 40.0}, std::pair{-66.0, 22.0}, std::pair{-58.0, 9.0}}) {
    const auto normals = normals_seen_from(place_near(x, y));
    ASSERT_GT(normals.size(), 500U);
    for (const Eigen::Vector3d& normal : normals) ASSERT_GT(normal.z(), 0.999);
  }
}

TEST_P(CompositeLoop, AlongTheWallThereIsTheWallToTheRightAndGround) {
  for (const double x : {80.0, 50.0, 20.0}) {
    int on_wall = 0;
    for (const Eigen::Vector3d& normal : normals_seen_from(place_near(x, 118.0))) {
      const bool wall = normal.y() < -0.999;
      on_wall += wall ? 1 : 0;
      ASSERT_TRUE(wall || normal.z() > 0.999) << normal.transpose();
    }
    EXPECT_GT(on_wall, 500);
  }
}

TEST_P(CompositeLoop, TwoPlacesAreDarkAndTheOthersLit) {
  for (const auto& [x, y] : {std::pair{36.0, 0.0}, std::pair{-58.0, 88.0}}) {
    EXPECT_LT(lamplight_at(place_near(x, y)), 2.0) << x << ", " << y;
  }
  for (const auto& [x, y] : {std::pair{10.0, 0.0}, std::pair{64.0, 0.0}, std::pair{110.0, 22.0}, std::pair{80.0, 118.0},
                             std::pair{20.0, 118.0}, std::pair{-66.0, 22.0}}) {
    EXPECT_GT(lamplight_at(place_near(x, y)), 10.0) << x << ", " << y;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CompositeLoop, ::testing::Values(1, 2, 77));

}  // namespace
}  // namespace plumbline
