#include "tools/formats/point_cloud_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "scenarios/input_error.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

std::string floats(const std::vector<float>& values, bool swapped = false) {
  std::string bytes;
  for (const float value : values) {
    char one[4];
    std::memcpy(one, &value, 4);
    if (swapped) std::swap(one[0], one[3]), std::swap(one[1], one[2]);
    bytes.append(one, 4);
  }
  return bytes;
}

std::string ply(const std::string& format, const std::string& count, const std::string& body) {
  return "ply\nformat " + format + " 1.0\ncomment anything\nelement vertex " + count +
         "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + body;
}

std::string pcd(const std::string& data, const std::string& count, const std::string& body) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + count +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA " + data + "\n" + body;
}

class PointCloudFile : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& name, const std::string& content) const {
    const auto path = directory_.path() / name;
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  std::vector<Eigen::Vector3d> read(const std::string& name, const std::string& content) const {
    std::vector<Eigen::Vector3d> points;
    read_point_cloud(written(name, content),
                     {[](const CloudHeader&) {}, [&](const CloudPoint& point) { points.push_back(point.position); }});
    return points;
  }
  /// What is said of a file that cannot be used.
  std::string complaint(const std::string& name, const std::string& content) const {
    try {
      read_prior_map(written(name, content));
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  }

  TemporaryDirectory directory_;
  const std::vector<Eigen::Vector3d> two_{{1.0, 2.0, 3.0}, {-4.0, 5.5, 0.25}};
  const std::vector<float> two_floats_{1.0F, 2.0F, 3.0F, -4.0F, 5.5F, 0.25F};
};

TEST_F(PointCloudFile, ReadsEveryKindAlike) {
  EXPECT_EQ(read("a.ply", ply("ascii", "2", "1 2 3\n\n -4 5.5 0.25 \r\n")), two_);
  EXPECT_EQ(read("l.ply", ply("binary_little_endian", "2", floats(two_floats_))), two_);
  EXPECT_EQ(read("b.ply", ply("binary_big_endian", "2", floats(two_floats_, true))), two_);
  EXPECT_EQ(read("a.pcd", pcd("ascii", "2", "1 2 3\n-4 5.5 0.25\n")), two_);
  EXPECT_EQ(read("b.pcd", pcd("binary", "2", floats(two_floats_))), two_);
  // x x y y z z, as one run of 24 literals.
  const std::string packed = char(23) + floats({1.0F, -4.0F, 2.0F, 5.5F, 3.0F, 0.25F});
  EXPECT_EQ(read("c.pcd", pcd("binary_compressed", "2", std::string("\x19\0\0\0\x18\0\0\0", 8) + packed)), two_);
}

TEST_F(PointCloudFile, SkipsOtherFieldsAndTypes) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty uchar red\nproperty double x\nproperty int y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float intensity\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  CloudPoint seen;
  bool normals = false;
  read_point_cloud(
      written("m.ply", header + "255 1.5 2 3 0 0 1 0.5\n3 0 0 0\n"),
      {[&](const CloudHeader& cloud) { normals = cloud.has_normals; }, [&](const CloudPoint& p) { seen = p; }});
  EXPECT_TRUE(normals);
  EXPECT_EQ(seen.position, Eigen::Vector3d(1.5, 2.0, 3.0));
  EXPECT_EQ(seen.normal, Eigen::Vector3f(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(seen.intensity, 0.5F);
}

TEST_F(PointCloudFile, OurOwnMapComesBackWithItsNormalsAndEdges) {
  MapPoint wall{{1.0F, 2.0F, 3.0F}, 0.5F};
  wall.normal = {0.0F, -1.0F, 0.0F};
  const MapPoint edge{{-1.0F, 0.0F, 0.25F}, 0.1F};
  const auto path = directory_.path() / "map.ply";
  write_ply(path.string(), {wall, edge});
  const PriorMap map = read_prior_map(path).map;
  ASSERT_EQ(map.surfaces.planes.size(), 1u);
  EXPECT_EQ(map.surfaces.planes.front().normal, wall.normal);
  ASSERT_EQ(map.surfaces.edges.size(), 1u);
  EXPECT_EQ(map.surfaces.edges.front().position, edge.position);
}

TEST_F(PointCloudFile, AMapSaysWhereItLiesOnItsSite) {
  const MapPoint corner{{1.0F, 0.0F, 0.0F}, 0.5F};
  const auto path = directory_.path() / "map.ply";
  write_ply(path.string(), {corner});
  EXPECT_FALSE(read_prior_map(path).site_from_map);
  const Pose place{rotation_from_rpy({0.1, 0.0, 2.0}), {10.0, -20.0, 1.0 / 3.0}};
  write_place_on_site(path, place);
  const SitedMap map = read_prior_map(path);
  ASSERT_TRUE(map.site_from_map);
  EXPECT_EQ(map.site_from_map->translation, place.translation);
  EXPECT_LT(map.site_from_map->rotation.angularDistance(place.rotation), 1e-15);
  EXPECT_EQ(map.map.thinned.front().position, corner.position);

  const std::string rest =
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
  const std::string begin = "ply\nformat ascii 1.0\ncomment site_from_cloud ";
  EXPECT_THAT(complaint("few.ply", begin + "0 0 0\n" + rest), HasSubstr("site_from_cloud has not seven numbers"));
  EXPECT_THAT(complaint("nan.ply", begin + "0 0 nan 0 0 0 1\n" + rest), HasSubstr("found 'nan' in site_from_cloud"));
  EXPECT_THAT(complaint("long.ply", begin + "0 0 0 0 0 0 2\n" + rest), HasSubstr("not of length one"));
}

TEST_F(PointCloudFile, SaysWhatItCannotUse) {
  EXPECT_THAT(complaint("t.txt", "1 2 3\n"), HasSubstr("t.txt: neither PLY nor PCD"));
  EXPECT_THAT(complaint("e.ply", ply("ascii", "0", "")), HasSubstr("e.ply: it has no points"));
  EXPECT_THAT(complaint("n.ply", ply("ascii", "1", "nan 0 0\n")), HasSubstr("none of its points is finite"));
  EXPECT_THAT(complaint("s.ply", ply("binary_little_endian", "3", floats(two_floats_))),
              HasSubstr("it ends after 2 of 3 points"));
  EXPECT_THAT(complaint("w.ply", ply("ascii", "1", "1 two 3\n")), HasSubstr("point 1 is '1 two 3'"));
  EXPECT_THAT(complaint("f.ply", ply("middle_endian", "1", "1 2 3\n")), HasSubstr("found format 'middle_endian'"));
  EXPECT_THAT(complaint("u.ply", ply("ascii", "1", "500000 5000000 3\n")), HasSubstr("in a local frame"));
  EXPECT_THAT(complaint("h.ply", "ply\n" + std::string(100'000, 'x')), HasSubstr("longer than 65536"));
  EXPECT_THAT(complaint("z.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
              HasSubstr("no x, y and z"));
  EXPECT_THAT(complaint("d.pcd", pcd("zip", "1", "")), HasSubstr("found DATA 'zip'"));
}

// Sizes in a file are claims: what it would take to believe them is never allocated.
TEST_F(PointCloudFile, BelievesNoSizeThatTheFileDoesNotHold) {
  const std::string huge("\xff\xff\xff\x3f\xff\xff\xff\x3f", 8);
  EXPECT_THAT(complaint("a.pcd", pcd("binary_compressed", "90000000000", huge)), HasSubstr("more than 1 GB"));
  EXPECT_THAT(complaint("b.pcd", pcd("binary_compressed", "2", std::string("\xff\0\0\0\x18\0\0\0", 8))),
              HasSubstr("ends within its compressed points"));
  EXPECT_THAT(complaint("c.pcd", pcd("binary_compressed", "2", std::string("\x02\0\0\0\x18\0\0\0", 8) + "\xe0\x01")),
              HasSubstr("damaged"));
  EXPECT_THAT(complaint("d.ply", ply("binary_little_endian", "90000000000000", "")), HasSubstr("ends after 0 of"));
}

}  // namespace
}  // namespace plumbline
