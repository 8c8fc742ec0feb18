#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sim/ray_scene.h"
#include "sim/scene_library.h"
#include "sim/scenes/routes.h"
#include "sim/world.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;

TEST(Street, ClimbsOverSeventyMetresAlongNineKilometres) {
  const Route tour = build_scene("street", {{"length_m", 9300}}, 1).routes.front();
  double low = tour.points.front().z();
  double high = low;
  for (const Vector3d& point : tour.points) {
    low = std::min(low, point.z());
    high = std::max(high, point.z());
  }
  EXPECT_GE(length_of(tour), 9250.0);
  EXPECT_GT(high - low, 70.0);
}

TEST(Campus, ItsCircuitIsAsLongAsTheThesiss) {
  const Route circuit = build_scene("campus", {}, 1).routes.front();
  EXPECT_TRUE(circuit.closed);
  EXPECT_NEAR(length_of(circuit), 2700.0, 30.0);
}

TEST(FlownRoutes, AreFreeForAMetreAround) {
  for (const std::string scene : {"bridge", "shed_site"}) {
    for (const std::uint64_t seed : {1ULL, 8ULL}) {
      const World world = World::from_scene(build_scene(scene, {}, seed), seed);
      const RayScene rays(world);
      for (const Route& route : world.routes()) {
        if (!route.flown) continue;
        for (const Vector3d& point : route.points) {
          ASSERT_GT(rays.distance_to_surface(point, 1.0), 0.99)
              << scene << " " << route.name << " " << point.transpose();
        }
      }
    }
  }
}

/// Ranges around a place on a route, seen along the route [m].
std::vector<float> view_from(const RayScene& rays, const Vector3d& place, double heading) {
  std::vector<float> ranges;
  for (int i = 0; i < 120; ++i) {
    for (const double pitch : {-0.15, 0.0, 0.15}) {
      const double azimuth = heading + i * M_PI / 60.0;
      const Vector3d way(std::cos(azimuth) * std::cos(pitch), std::sin(azimuth) * std::cos(pitch), std::sin(pitch));
      const RayHit hit = rays.cast(place + 1.5 * Vector3d::UnitZ(), way, 0.0, 60.0);
      ranges.push_back(hit.hit ? static_cast<float>(hit.range_m) : 0.0F);
    }
  }
  return ranges;
}

double share_alike(const std::vector<float>& one, const std::vector<float>& two) {
  int alike = 0;
  int seen = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (one[i] == 0.0F && two[i] == 0.0F) continue;
    ++seen;
    alike += std::abs(one[i] - two[i]) < 0.01F ? 1 : 0;
  }
  return seen == 0 ? 0.0 : static_cast<double>(alike) / seen;
}

// What repeats lets an estimator lock on to the wrong place, as nothing outside would. Level ground looks the same to
// a lidar wherever one stands on it, so that half of a view may do so.
TEST(Outdoors, NoTwoPlacesWithinFiftyMetresLookAlike) {
  const std::pair<std::string, SceneValues> scenes[] = {{"street", {{"length_m", 400}}},
                                                        {"campus", {{"length_m", 500}}},
                                                        {"highway", {{"length_m", 400}}},
                                                        {"trail", {{"length_m", 300}}},
                                                        {"orchard", {}},
                                                        {"vegetated_road", {}}};
  for (const auto& [scene, values] : scenes) {
    const World world = World::from_scene(build_scene(scene, values, 5), 5);
    const RayScene rays(world);
    const Route& route = world.routes().front();
    std::vector<std::vector<float>> views;
    double since_m = 0.0;
    for (std::size_t i = 1; i < route.points.size() && views.size() < 60; ++i) {
      const Vector3d leg = route.points[i] - route.points[i - 1];
      since_m += leg.norm();
      if (since_m < 5.0) continue;
      since_m = 0.0;
      views.push_back(view_from(rays, route.points[i], std::atan2(leg.y(), leg.x())));
    }
    ASSERT_GE(views.size(), 10U) << scene;
    for (std::size_t a = 0; a < views.size(); ++a) {
      for (std::size_t b = a + 1; b < std::min(views.size(), a + 11); ++b) {
        EXPECT_LT(share_alike(views[a], views[b]), 0.6) << scene << ", " << 5 * a << " and " << 5 * b << " m";
      }
    }
  }
}

}  // namespace
}  // namespace plumbline
