#include "tools/formats/message_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>
#include <sstream>

#include "scenarios/input_error.h"
#include "tools/formats/calibration_yaml.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

Calibration calibration() {
  Calibration calibration;
  calibration.camera = {3, 2, 500.0, 500.0, 1.0, 0.5, {}};
  return calibration;
}

ImuSample imu_sample() { return {-5, {0.1, -0.0, std::numeric_limits<double>::infinity()}, {1e-310, 2.0, 9.81}}; }
CameraFrame camera_frame() { return {20, 1, 3, 2, {0, 50, 100, 150, 200, 255}}; }
DepthFrame depth_frame() { return {30, 2, 2, 1, {kNoNumber, 1.5F}}; }
LidarScan lidar_scan() {
  return {
      40, 50, {{{1.0F, -2.0F, kNoNumber}, -7, 65'535, 0.25F}, {{4.0F, 5.0F, 6.0F}, 2'000'000'000, 3, 1.0F}}, 9, false};
}

std::string whole_stream() {
  return message_stream_header(calibration()) + message_record(imu_sample(), 1) + message_record(camera_frame(), 20) +
         message_record(depth_frame(), 20) + message_record(lidar_scan(), 60) + message_record(LidarScan{}, 60) +
         message_end_record();
}

/// Reads to the end or to the first complaint, which it gives.
std::string complaint(const std::string& bytes) {
  std::istringstream stream(bytes);
  try {
    MessageStreamReader reader(stream, "messages.plb");
    while (reader.read()) {
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

template <typename T>
std::string with(std::string bytes, std::size_t place, T value) {
  std::memcpy(bytes.data() + place, &value, sizeof(T));
  return bytes;
}

TEST(MessageStream, GivesEveryMessageBackBitByBit) {
  const std::string bytes = whole_stream();
  std::istringstream stream(bytes);
  MessageStreamReader reader(stream, "messages.plb");
  EXPECT_EQ(reader.calibration_text(), calibration_yaml(calibration()));
  std::string again = message_stream_header(reader.calibration());
  std::vector<SensorMessage> messages;
  while (auto message = reader.read()) {
    again += message_record(message->payload, message->delivery_ns);
    messages.push_back(std::move(*message));
  }
  EXPECT_EQ(again + message_end_record(), bytes);
  EXPECT_FALSE(reader.read());

  ASSERT_EQ(messages.size(), 5U);
  EXPECT_EQ(std::get<ImuSample>(messages[0].payload).angular_rate, imu_sample().angular_rate);
  EXPECT_EQ(std::get<CameraFrame>(messages[1].payload).pixels, camera_frame().pixels);
  EXPECT_EQ(std::get<CameraFrame>(messages[1].payload).camera_id, 1);
  EXPECT_EQ(std::get<DepthFrame>(messages[2].payload).depth_m[1], 1.5F);
  const LidarScan scan = std::get<LidarScan>(messages[3].payload);
  EXPECT_EQ(scan.end_ns, 50);
  EXPECT_EQ(scan.sweep, 9);
  EXPECT_FALSE(scan.ends_sweep);
  ASSERT_EQ(scan.points.size(), 2U);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(scan.points[0].position.z()), std::bit_cast<std::uint32_t>(kNoNumber));
  EXPECT_EQ(scan.points[0].ring, 65'535);
  EXPECT_EQ(scan.points[1].offset_ns, 2'000'000'000);
  EXPECT_EQ(messages[3].delivery_ns, 60);
}

TEST(MessageStream, BytesStandWhereTheDocumentSays) {
  // What other people's programs read must not move.
  const std::string record = message_record(lidar_scan(), 60);
  ASSERT_EQ(record.size(), 16U + 32U + 2U * 24U);
  EXPECT_EQ(record.substr(0, 8), std::string("\4\0\0\0\x50\0\0\0", 8));
  EXPECT_EQ(record.substr(16 + 32 + 16, 8), std::string("\xf9\xff\xff\xff\xff\xff\0\0", 8));
  EXPECT_EQ(message_record(imu_sample(), 0).size(), 16U + 56U);
  EXPECT_EQ(message_record(camera_frame(), 0).size(), 16U + 20U + 6U);
  EXPECT_EQ(message_record(depth_frame(), 0).size(), 16U + 20U + 8U);
  EXPECT_EQ(message_end_record().size(), 16U);
}

TEST(MessageStream, CutShortAnywhereItSaysSo) {
  const std::string bytes = whole_stream();
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_THAT(complaint(bytes.substr(0, size)), HasSubstr("cut short")) << size;
  }
  EXPECT_THAT(complaint(bytes + "x"), HasSubstr("goes on after its end"));
}

TEST(MessageStream, RefusesWhatCannotBe) {
  const std::string header = message_stream_header(calibration());
  const std::string camera = header + message_record(camera_frame(), 20);
  const std::size_t at = header.size();
  EXPECT_THAT(complaint("PLUMBING and other things"), HasSubstr("messages.plb: before byte 8: no message stream"));
  EXPECT_THAT(complaint(with(header, 8, std::uint32_t{2})), HasSubstr("version 2; this program reads version 1"));
  EXPECT_THAT(complaint(with(header, 12, ~std::uint32_t{0})), HasSubstr("a calibration of 4294967295 bytes"));
  EXPECT_THAT(complaint(with(header, 16, 'x')), HasSubstr("calibration_version"));
  EXPECT_THAT(complaint(with(camera, at, std::uint32_t{5})), HasSubstr("record 1, before byte"));
  EXPECT_THAT(complaint(with(camera, at, std::uint32_t{1})), HasSubstr("not what its fields ask for"));
  EXPECT_THAT(complaint(with(camera, at + 4, ~std::uint32_t{0})), HasSubstr("a payload of 4294967295 bytes"));
  EXPECT_THAT(complaint(with(camera, at + 28, std::uint32_t{4})), HasSubstr("not what its fields ask for"));
  EXPECT_THAT(complaint(with(camera, at + 28, ~std::uint32_t{0})), HasSubstr("not what its fields ask for"));
  EXPECT_THAT(complaint(camera + message_record(imu_sample(), 19)), HasSubstr("delivery_ns goes back"));
  // A size that lies asks for no memory: 256 MB that are not there.
  EXPECT_THAT(complaint(with(camera, at + 4, std::uint32_t{1U << 28})), HasSubstr("cut short"));
  const std::string scan = header + message_record(lidar_scan(), 20);
  EXPECT_THAT(complaint(with(scan, at + 16 + 28, ~std::uint32_t{0})), HasSubstr("not what its fields ask for"));
}

TEST(MessageStream, AnImageThatIsNoneIsNotWritten) {
  CameraFrame frame = camera_frame();
  frame.pixels.pop_back();
  EXPECT_THROW(message_record(frame, 0), std::invalid_argument);
  frame.width = -1;
  EXPECT_THROW(message_record(frame, 0), std::invalid_argument);
}

}  // namespace
}  // namespace plumbline
