#include "tools/formats/ros_conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>

#include "tests/tools/formats/synthetic_messages.h"
#include "tools/formats/ros_cdr.h"

namespace plumbline {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kStamp_ns = 1'600'000'000'123'456'789;

/// A cloud of x, y, z, a ring (uint16) and a time of some type.
template <typename Time>
RosPointCloud cloud_with_times(const char* name, std::uint8_t datatype, std::initializer_list<Time> times) {
  RosPointCloud cloud;
  cloud.stamp_ns = kStamp_ns;
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(times.size());
  cloud.fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}, {"ring", 12, 4, 1}, {name, 16, datatype, 1}};
  cloud.point_step = 24;
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  std::size_t at = 0;
  for (const Time time : times) {
    const float xyz[3] = {1.0F, 2.0F, 3.0F};
    std::memcpy(cloud.data.data() + at, xyz, sizeof(xyz));
    std::memcpy(cloud.data.data() + at + 16, &time, sizeof(time));
    at += cloud.point_step;
  }
  return cloud;
}

std::vector<std::int64_t> times_of(const LidarScan& scan) {
  std::vector<std::int64_t> times_ns;
  for (const LidarPoint& point : scan.points) times_ns.push_back(scan.stamp_ns + point.offset_ns - kStamp_ns);
  return times_ns;
}

template <typename Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ScanOfCloud, ReadsTheTimesOfDrivers) {
  // Velodyne: float32 seconds, here before the stamp, as where the stamp is the sweep's end.
  EXPECT_THAT(times_of(scan_of(cloud_with_times<float>("time", 7, {0.0F, -0.0625F}))),
              testing::ElementsAre(-62'500'000, 0));
  // Ouster: uint32 nanoseconds.
  EXPECT_THAT(times_of(scan_of(cloud_with_times<std::uint32_t>("t", 6, {99'999'999U, 1U}))),
              testing::ElementsAre(1, 99'999'999));
  // Hesai: float64 seconds since 1970, which resolve a quarter of a microsecond.
  const auto hesai =
      times_of(scan_of(cloud_with_times<double>("timestamp", 8, {1'600'000'000.133, 1'600'000'000.223})));
  EXPECT_NEAR(static_cast<double>(hesai[0]), 9'543'211.0, 250.0);
  EXPECT_NEAR(static_cast<double>(hesai[1]), 99'543'211.0, 250.0);
}

TEST(ScanOfCloud, PointsWithoutATimeOrPlaceAreLeftOut) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  RosPointCloud cloud = cloud_with_times<float>("time", 7, {0.0F, kNan, 1e30F, 0.01F});
  std::memcpy(cloud.data.data() + 3 * cloud.point_step, &kNan, sizeof(kNan));
  EXPECT_EQ(scan_of(cloud).points.size(), 1U);
}

TEST(ScanOfCloud, RowsOfAnOrganisedCloudAreRings) {
  RosPointCloud cloud = cloud_with_times<float>("time", 7, {0.0F, 0.01F, 0.02F, 0.03F});
  cloud.fields.erase(cloud.fields.begin() + 3);
  EXPECT_THAT(refusal([&] { scan_of(cloud); }), HasSubstr("without a field ring"));
  cloud.height = 2;
  cloud.width = 2;
  cloud.row_step = 2 * cloud.point_step;
  const LidarScan scan = scan_of(cloud);
  EXPECT_EQ(scan.points.front().ring, 1);
  EXPECT_EQ(scan.points.back().ring, 0);
}

TEST(ScanOfCloud, SizesThatDoNotAgreeAreRefused) {
  const RosPointCloud good = cloud_with_times<float>("time", 7, {0.0F, 0.01F});
  EXPECT_EQ(refusal([&] { scan_of(good); }), "");
  const auto refused = [&](auto change) {
    RosPointCloud bad = good;
    change(bad);
    return !refusal([&] { scan_of(bad); }).empty();
  };
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.data.pop_back(); }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.width = 4'000'000'000U; }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.height = 4'000'000'000U; }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.row_step = 1; }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.point_step = 0; }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.point_step = 15; }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.fields[0].offset = 4'294'967'295U; }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.fields[0].datatype = 77; }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.fields[0].name = "u"; }));
  EXPECT_TRUE(refused([](RosPointCloud& c) { c.is_bigendian = true; }));
}

TEST(FrameOfImage, ColoursBecomeGrey) {
  RosImage image{0, 1, 2, "rgb8", false, 6, {255, 0, 0, 10, 10, 10}};
  // BT.601: red counts 0.299.
  EXPECT_THAT(frame_of(image, 0).pixels, testing::ElementsAre(76, 10));
  image.encoding = "bgr8";
  EXPECT_THAT(frame_of(image, 0).pixels, testing::ElementsAre(29, 10));
}

TEST(FrameOfImage, RowsMayBePadded) {
  const RosImage image{0, 2, 2, "mono8", false, 3, {1, 2, 0, 3, 4, 0}};
  EXPECT_THAT(frame_of(image, 0).pixels, testing::ElementsAre(1, 2, 3, 4));
}

TEST(FrameOfImage, SizesThatDoNotAgreeAreRefused) {
  const RosImage good{0, 2, 2, "mono8", false, 2, {1, 2, 3, 4}};
  EXPECT_EQ(refusal([&] { frame_of(good, 0); }), "");
  const auto refused = [&](auto change) {
    RosImage bad = good;
    change(bad);
    return refusal([&] { frame_of(bad, 0); });
  };
  EXPECT_NE(refused([](RosImage& i) { i.step = 1; }), "");
  EXPECT_NE(refused([](RosImage& i) { i.step = 0; }), "");
  EXPECT_NE(refused([](RosImage& i) { i.data.pop_back(); }), "");
  EXPECT_NE(refused([](RosImage& i) { i.width = 4'000'000'000U; }), "");
  EXPECT_NE(refused([](RosImage& i) { i.height = 0; }), "");
  EXPECT_THAT(refused([](RosImage& i) { i.encoding = "bayer_rggb8"; }), HasSubstr("bayer_rggb8"));
}

TEST(DepthOfImage, ReadsMillimetres) {
  const RosImage image{0, 1, 2, "16UC1", false, 4, {0, 0, 0xE8, 0x03}};
  EXPECT_THAT(depth_of(image, 2).depth_m, testing::ElementsAre(0.0F, testing::FloatEq(1.0F)));
}

TEST(Cdr, EveryCutIsRefused) {
  const RosPayload payloads[] = {cloud_of(synthetic_scan(0, 1000, 4)), RosImage{-5, 1, 2, "mono8", false, 2, {1, 2}},
                                 ImuSample{7, {1, 2, 3}, {4, 5, 6}}, PoseTrack::Stamped{}};
  for (const RosPayload& payload : payloads) {
    const std::string bytes = to_cdr(payload);
    ASSERT_TRUE(from_cdr(ros2_type(payload), bytes));
    // What a cloud has behind its points is not read.
    const std::size_t unread = std::holds_alternative<RosPointCloud>(payload) ? 1 : 0;
    for (std::size_t size = 0; size + unread < bytes.size(); ++size) {
      EXPECT_THROW(from_cdr(ros2_type(payload), std::string_view(bytes).substr(0, size)), std::invalid_argument)
          << size;
    }
  }
}

TEST(Cdr, TimesBefore1970AreKept) {
  const auto back = from_cdr("sensor_msgs/msg/Imu", to_cdr(ImuSample{-1'500'000'001, {}, {}}));
  EXPECT_EQ(std::get<ImuSample>(*back).stamp_ns, -1'500'000'001);
}

TEST(Cdr, OtherTypesAreNotRead) { EXPECT_FALSE(from_cdr("std_msgs/msg/String", to_cdr(ImuSample{}))); }

}  // namespace
}  // namespace plumbline
