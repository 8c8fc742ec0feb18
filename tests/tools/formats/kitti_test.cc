#include "tools/formats/kitti.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <numbers>

#include "scenarios/input_error.h"
#include "scenarios/yaml_reader.h"
#include "tests/scenarios/temporary_directory.h"
#include "tests/tools/formats/input_message.h"
#include "tests/tools/formats/synthetic_messages.h"
#include "tools/formats/clock_source.h"
#include "tools/formats/kitti_points.h"
#include "tools/formats/kitti_stamps.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A scan as KITTI would have written it: no times, no rings, in its order.
std::vector<LidarPoint> stripped(const LidarScan& scan) {
  std::vector<LidarPoint> points = scan.points;
  sort_as_kitti(points);
  for (LidarPoint& point : points) {
    point.offset_ns = 0;
    point.ring = 0;
  }
  return points;
}

TEST(KittiPoints, TimesAndRingsFollowFromAzimuth) {
  const LidarScan scan = synthetic_scan(0, 100'000'000, 200);
  std::vector<LidarPoint> points = stripped(scan);
  assign_rings_by_azimuth(4, points);
  assign_times_by_azimuth(100'000'000, points);
  sort_by_time(points);
  ASSERT_EQ(points.size(), scan.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].ring, scan.points[i].ring);
    // Single-precision coordinates tell the azimuth to 1e-7 rad.
    EXPECT_NEAR(points[i].offset_ns, scan.points[i].offset_ns, 10);
  }
}

TEST(KittiPoints, StepsAcrossTheSeamAreNoNewRing) {
  // Motion compensation has moved the first ring's first point behind the seam and the second ring's last one over it.
  std::vector<LidarPoint> points;
  for (const double degrees : {359.9, 0.2, 120.0, 240.0, 359.8, 0.1, 120.0, 240.0, 359.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    LidarPoint point;
    point.position = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0).cast<float>();
    points.push_back(point);
  }
  assign_rings_by_azimuth(2, points);
  std::vector<int> rings;
  for (const LidarPoint& point : points) rings.push_back(point.ring);
  EXPECT_THAT(rings, testing::ElementsAre(1, 1, 1, 1, 1, 0, 0, 0, 0));
}

TEST(KittiPoints, MoreRingsThanTheDeviceHasAreDropped) {
  std::vector<LidarPoint> points = stripped(synthetic_scan(0, 100'000'000, 50));
  assign_rings_by_azimuth(3, points);
  EXPECT_EQ(points.size() % 3, 0U);
  EXPECT_LT(points.size(), synthetic_scan(0, 100'000'000, 50).points.size());
}

class PcdFile : public ::testing::Test {
 protected:
  std::string header(const std::string& points, const std::string& data) const {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\n"
           "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
           points + "\nDATA " + data + "\n";
  }
  std::string binary(std::initializer_list<float> values) const {
    return {reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(float)};
  }
  std::vector<LidarPoint> read(const std::string& bytes) const {
    return read_kitti_points(directory_.write("0.pcd", bytes));
  }

  TemporaryDirectory directory_;
};

TEST_F(PcdFile, IsReadInBothNotations) {
  // Bytes past the points are padding.
  for (const std::string& bytes : {header("2", "binary") + binary({1, 2, 3, 0.5F, 4, 5, 6, 1, 9, 9, 9, 9}),
                                   header("2", "ascii") + "1 2 3 0.5\n4 5 6 1\n"}) {
    const auto points = read(bytes);
    ASSERT_EQ(points.size(), 2U);
    EXPECT_EQ(points[1].position, Eigen::Vector3f(4.0F, 5.0F, 6.0F));
    EXPECT_EQ(points[0].intensity, 0.5F);
  }
}

TEST_F(PcdFile, DamagedOnesAreRefused) {
  EXPECT_THAT(input_message_of([&] {
                read(header("3", "binary") + binary({1, 2, 3, 4}));
              }),
              HasSubstr("ends after 1 of 3 points"));
  EXPECT_THAT(input_message_of([&] { read(header("3", "ascii") + "1 2 3 4\n"); }),
              HasSubstr("ends after 1 of 3 points"));
  EXPECT_THAT(input_message_of([&] { read(header("1e30", "binary")); }), HasSubstr("found '1e30' for a count"));
  EXPECT_THAT(input_message_of([&] { read(header("2", "binary_compressed")); }), HasSubstr("ends before its points"));
  EXPECT_THAT(input_message_of([&] { read(std::string(10'000, 'x')); }), HasSubstr("no line 'DATA'"));
  EXPECT_THAT(input_message_of([&] { read("FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA binary\n"); }),
              HasSubstr("no x, y and z"));
  EXPECT_THAT(input_message_of([&] { read("FIELDS x y z\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA binary\n"); }),
              HasSubstr("do not go together"));
}

TEST(KittiStamps, ReadsDatesExactly) {
  const TemporaryDirectory directory;
  const auto stamps =
      read_kitti_stamps(directory.write("t.txt", "1970-01-02 00:00:01.000000007\n2011-09-26 13:02:25.951199337\n"));
  // `date -u -d '2011-09-26 13:02:25' +%s`
  EXPECT_THAT(stamps, testing::ElementsAre(86'401'000'000'007, 1'317'042'145'951'199'337));
  EXPECT_THAT(input_message_of([&] { read_kitti_stamps(directory.write("u.txt", "2011-02-30 13:02:25.9\n")); }),
              HasSubstr("u.txt:1: there is no such day"));
}

/// A raw drive of two scans, and what is wrong with it.
class KittiRaw : public ::testing::Test {
 protected:
  KittiRaw() {
    fs::create_directories(path("velodyne_points/data"));
    for (int i = 0; i < 2; ++i) {
      write("velodyne_points/data/000000000" + std::to_string(i) + ".bin",
            kitti_bin(stripped(synthetic_scan(0, 100'000'000, 40))));
    }
    write("velodyne_points/timestamps_start.txt", "2011-09-26 13:02:25.0\n2011-09-26 13:02:25.1\n");
    write("velodyne_points/timestamps_end.txt", "2011-09-26 13:02:25.1\n2011-09-26 13:02:25.2\n");
    settings_.calibration = read_yaml_text("lidar: {rings: 4}", "--set", {});
  }

  fs::path path(const std::string& name) const { return directory_.path() / name; }
  void write(const std::string& name, const std::string& bytes) const { directory_.write(name, bytes); }
  std::string complaint() const {
    return input_message_of([&] { drained(open_kitti(directory_.path(), settings_).recording.messages); });
  }

  TemporaryDirectory directory_;
  DatasetSettings settings_;
};

TEST_F(KittiRaw, WithoutAnImuGivesScansAndAClock) {
  const Dataset dataset = open_kitti(directory_.path(), settings_);
  EXPECT_FALSE(dataset.has_imu);
  EXPECT_TRUE(dataset.recording.truth.empty());
  const auto messages = drained(dataset.recording.messages);
  const auto scans = only<LidarScan>(messages);
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[1].stamp_ns, scans[0].end_ns);
  EXPECT_EQ(scans[0].points.back().ring, 3);
  EXPECT_GT(scans[0].points.back().offset_ns, 95'000'000);
  // The clock begins before the first scan does and answers each scan at its end.
  const auto ticks = only<ImuSample>(messages);
  EXPECT_LT(ticks.front().stamp_ns, scans[0].stamp_ns);
  EXPECT_EQ(ticks.back().stamp_ns, scans[1].end_ns);
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    EXPECT_GT(ticks[i].stamp_ns, ticks[i - 1].stamp_ns);
    EXPECT_LE(ticks[i].stamp_ns - ticks[i - 1].stamp_ns, 10'000'000);
  }
}

TEST_F(KittiRaw, MotionCompensatedPointsAreAllOfOneTime) {
  settings_.point_times = PointTimes::kNone;
  const auto scans = only<LidarScan>(drained(open_kitti(directory_.path(), settings_).recording.messages));
  ASSERT_EQ(scans.size(), 2U);
  for (const LidarPoint& point : scans[0].points) EXPECT_EQ(point.offset_ns, 0);
}

TEST_F(KittiRaw, RowsThatAreNoPointsAreLeftOut) {
  std::vector<LidarPoint> points = stripped(synthetic_scan(0, 100'000'000, 40));
  const std::size_t whole = points.size();
  points[3].position.x() = std::numeric_limits<float>::quiet_NaN();
  points[5].position.y() = 1e30F;
  points[7].position.setZero();
  write("velodyne_points/data/0000000000.bin", kitti_bin(points));
  const auto scans = only<LidarScan>(drained(open_kitti(directory_.path(), settings_).recording.messages));
  EXPECT_EQ(scans[0].points.size(), whole - 3);
}

TEST_F(KittiRaw, DamagedFilesAreNamed) {
  write("velodyne_points/data/0000000001.bin", std::string(17, 'x'));
  EXPECT_THAT(complaint(), HasSubstr("0000000001.bin: found 17 bytes, expected a multiple of 16"));
}

TEST_F(KittiRaw, StampsThatAreMissingOrImpossibleAreNamed) {
  write("velodyne_points/timestamps_start.txt", "2011-09-26 13:02:25.0\n");
  EXPECT_THAT(complaint(), HasSubstr("found 1 lines, but there is a file number 1"));
  write("velodyne_points/timestamps_start.txt", "2011-09-26 13:02:25.0\n2011-09-26 13:02:25.3\n");
  EXPECT_THAT(complaint(), HasSubstr("allowed are up to 2 s"));
  write("velodyne_points/timestamps_start.txt", "2011-09-26 13:02:25.0\nnever\n");
  EXPECT_THAT(complaint(), HasSubstr("timestamps_start.txt:2: 'never' is not a time"));
}

TEST_F(KittiRaw, TimesOfTheirOwnMustFitThePoints) {
  fs::create_directory(path("times"));
  write("times/0000000000.bin", std::string(8, '\0'));
  EXPECT_THAT(complaint(), HasSubstr("expected 4 for each of the scan's"));
}

TEST_F(KittiRaw, ImagesThatAreNoneAreNamed) {
  fs::create_directories(path("image_00/data"));
  write("image_00/timestamps.txt", "2011-09-26 13:02:25.05\n");
  write("image_00/data/0000000000.png", "no picture");
  EXPECT_THAT(complaint(), HasSubstr("0000000000.png: no image that can be read"));
  // A header that promises 2^31 pixels a side.
  std::string png(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\0\0\0\0\x31\xa2\x54\xba\0\0\0\0IDAT", 41);
  write("image_00/data/0000000000.png", png);
  EXPECT_THAT(complaint(), HasSubstr("allowed are sides to 8192"));
}

TEST_F(KittiRaw, AMatrixThatIsNoRotationIsRefused) {
  fs::create_directories(path("image_00/data"));
  write("image_00/timestamps.txt", "2011-09-26 13:02:25.05\n");
  write("image_00/data/0000000000.png", "x");
  write("calib_velo_to_cam.txt", "R: 1 0 0 0 1 0 0 0 -1\nT: 0 0 0\n");
  write("calib_cam_to_cam.txt",
        "R_rect_00: 1 0 0 0 1 0 0 0 1\nP_rect_00: 7 0 6 0 0 7 6 0 0 0 1 0\nP_rect_01: 7 0 6 0 0 7 6 0 0 0 1 0\n");
  EXPECT_THAT(complaint(), HasSubstr("no rotation and translation"));
}

TEST(Kitti, AFolderWithoutScansIsRefused) {
  const TemporaryDirectory directory;
  EXPECT_THAT(input_message_of([&] { open_kitti(directory.path(), {}); }), HasSubstr("holds no scans"));
  EXPECT_THAT(input_message_of([&] { open_kitti(directory.path() / "nowhere", {}); }), HasSubstr("no such folder"));
}

}  // namespace
}  // namespace plumbline
