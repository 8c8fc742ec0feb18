#include "estimator/lidar/voxel_map.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

MapSample sample(const Eigen::Vector3d& position, const Eigen::Vector3f& normal = Eigen::Vector3f::UnitZ()) {
  return {position, normal};
}

int found(VoxelMap& map, const Eigen::Vector3d& query, const Eigen::Vector3f& normal = Eigen::Vector3f::UnitZ()) {
  map.prepare({query});
  NearestSamples nearest(10, 1.0, normal);
  map.nearest(query, 1.0, nearest);
  return nearest.size();
}

TEST(VoxelMap, FindsTheNearestAsBruteForceDoesAcrossVoxelBorders) {
  VoxelMap map(10.0, 0.01);
  RandomStream random(1, "points");
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 4000; ++k) {
    points.emplace_back(random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-1, 1));
    map.insert(sample(points.back()), 0.0F, 0.0);
  }
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector3d query(random.uniform(-11, 11), random.uniform(-1, 1), 0.0);  // most reach over y = 0
    map.prepare({query});
    NearestSamples nearest(10, 1.0, Eigen::Vector3f::Zero());
    map.nearest(query, 1.0, nearest);
    std::vector<double> distances;
    for (const auto& p : points) distances.push_back((p - query).norm());
    std::sort(distances.begin(), distances.end());
    for (int i = 0; i < nearest.size(); ++i) {
      EXPECT_NEAR((nearest[i].position - query).norm(), distances[static_cast<std::size_t>(i)], 1e-9);
    }
    EXPECT_EQ(nearest.size(), std::min<std::ptrdiff_t>(10, std::count_if(distances.begin(), distances.end(),
                                                                         [](double d) { return d < 1.0; })));
  }
}

TEST(VoxelMap, ACellKeepsTheMeanOfWhatFallsIntoIt) {
  VoxelMap map(10.0, 0.4);
  for (const double z : {0.09, 0.10, 0.11}) map.insert(sample({5.1, 5.1, z}), 0.5F, 0.0);
  std::vector<MapPoint> points;
  map.collect(points);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0].position.z(), 0.10F, 1e-6F);
}

TEST(VoxelMap, TheTwoFacesOfADoorLeafStayApart) {
  VoxelMap map(10.0, 0.4);
  map.insert(sample({5.10, 5.1, 0.1}, Eigen::Vector3f::UnitX()), 0.0F, 0.0);
  map.insert(sample({5.05, 5.1, 0.1}, -Eigen::Vector3f::UnitX()), 0.0F, 0.0);
  EXPECT_EQ(found(map, {5.1, 5.1, 0.1}, Eigen::Vector3f::UnitX()), 1);
  EXPECT_EQ(found(map, {5.1, 5.1, 0.1}, -Eigen::Vector3f::UnitX()), 1);
}

TEST(VoxelMap, ForgetsByPathLength) {
  VoxelMap map(10.0, 0.4);
  map.insert(sample({1.0, 1.0, 0.0}), 0.0F, 0.0);
  map.insert(sample({1.5, 1.0, 0.0}), 0.0F, 120.0);
  EXPECT_EQ(found(map, {1.2, 1.0, 0.0}), 2);
  map.forget_before(100.0);
  EXPECT_EQ(found(map, {1.2, 1.0, 0.0}), 1);
  map.insert(sample({1.0, 1.0, 0.0}), 0.0F, 401.0);  // seen again: a new cell
  EXPECT_EQ(found(map, {1.2, 1.0, 0.0}), 2);
  std::vector<MapPoint> points;
  map.collect(points);
  EXPECT_EQ(points.size(), 2U);
}

}  // namespace
}  // namespace plumbline
