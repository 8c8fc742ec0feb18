#include <gtest/gtest.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <filesystem>
#include <tuple>

#include "estimator/estimator.h"

namespace plumbline {
namespace {

std::size_t points_read_back(const std::vector<MapPoint>& points) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "plumbline_map_export_test.ply";
  write_ply(path.string(), points);
  pcl::PointCloud<pcl::PointXYZI> cloud;
  EXPECT_GE(pcl::io::loadPLYFile(path.string(), cloud), 0);
  std::filesystem::remove(path);
  return cloud.size();
}

TEST(MapExport, WritesWhatPclReads) {
  EXPECT_EQ(points_read_back({{{1.0F, 2.0F, 3.0F}, 0.5F}, {{-1.0F, 0.0F, 0.25F}, 0.1F}}), 2u);
}

TEST(MapExport, WritesColoursWhereThereAreAny) {
  MapPoint seen{{1.0F, 2.0F, 3.0F}, 0.5F};
  seen.coloured = true;
  seen.colour = {200, 100, 50};
  const MapPoint unseen{{-1.0F, 0.0F, 0.25F}, 0.1F};
  const auto path = std::filesystem::path(::testing::TempDir()) / "plumbline_map_colour_test.ply";
  write_ply(path.string(), {seen, unseen});
  pcl::PointCloud<pcl::PointXYZRGB> cloud;
  ASSERT_GE(pcl::io::loadPLYFile(path.string(), cloud), 0);
  std::filesystem::remove(path);
  ASSERT_EQ(cloud.size(), 2u);
  EXPECT_EQ(cloud[0].z, 3.0F);
  EXPECT_EQ(std::make_tuple(cloud[0].r, cloud[0].g, cloud[0].b), std::make_tuple(200, 100, 50));
  EXPECT_EQ(std::make_tuple(cloud[1].r, cloud[1].g, cloud[1].b), std::make_tuple(128, 128, 128));
}

TEST(MapExport, WritesNormalsForWhoeverMatchesWithTheMap) {
  MapPoint wall{{1.0F, 2.0F, 3.0F}, 0.5F};
  wall.normal = {0.0F, -1.0F, 0.0F};
  const auto path = std::filesystem::path(::testing::TempDir()) / "plumbline_map_normal_test.ply";
  write_ply(path.string(), {wall});
  pcl::PointCloud<pcl::PointNormal> cloud;
  ASSERT_GE(pcl::io::loadPLYFile(path.string(), cloud), 0);
  std::filesystem::remove(path);
  ASSERT_EQ(cloud.size(), 1u);
  EXPECT_EQ(cloud[0].normal_y, -1.0F);
}

TEST(MapExport, WritesAMapWithoutPoints) { EXPECT_EQ(points_read_back({}), 0u); }

TEST(MapExport, SaysWhichFileItCannotWrite) {
  EXPECT_THROW(write_ply("no/such/folder/map.ply", {}), std::runtime_error);
}

}  // namespace
}  // namespace plumbline
