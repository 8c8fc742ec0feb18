#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenarios/input_error.h"
#include "scenarios/yaml_reader.h"
#include "tests/scenarios/temporary_directory.h"
#include "tests/tools/formats/synthetic_messages.h"
#include "tools/formats/calibration_yaml.h"

namespace plumbline {
namespace {

struct FormatCase {
  const char* name;
  bool imu, lidar, right_camera, depth;
  double depth_step_m;        // resolution of a depth image; beyond its largest value there is none
  std::int64_t time_step_ns;  // of a point's time
  bool exact_scan_end;
};

// The formats' own limits: KITTI's point times are float32 seconds, TUM's depths 1/5000 m, and a PointCloud2 ends with
// its last point.
const FormatCase kCases[] = {
    {"plumbline", true, true, true, true, 0.0, 0, true}, {"kitti", true, true, true, false, 0.0, 4, true},
    {"euroc", true, false, true, false, 0.0, 0, true},   {"tum", false, false, false, true, 1.0 / 5000.0, 0, true},
    {"rosbag", true, true, true, true, 0.0, 0, false},   {"rosbag2", true, true, true, true, 0.0, 0, false},
};

class DatasetRoundTrip : public ::testing::TestWithParam<FormatCase> {
 protected:
  DatasetRoundTrip() {
    const auto writer = make_dataset_writer(GetParam().name, directory_.path(), synthetic_calibration());
    for (const SensorMessage& message : session_.messages) writer->write(message);
    writer->finish(session_.truth);
    dataset_ = open_dataset(GetParam().name, directory_.path(), {});
    read_ = drained(dataset_.recording.messages);
  }

  TemporaryDirectory directory_;
  SyntheticSession session_ = synthetic_session();
  Dataset dataset_;
  std::vector<SensorMessage> read_;
};

TEST_P(DatasetRoundTrip, GivesBackTheImu) {
  const auto expected = only<ImuSample>(session_.messages);
  const auto found = only<ImuSample>(read_);
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(dataset_.has_imu, GetParam().imu);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].stamp_ns, expected[i].stamp_ns);
    EXPECT_EQ(found[i].specific_force, expected[i].specific_force);
    if (GetParam().imu) {
      EXPECT_EQ(found[i].angular_rate, expected[i].angular_rate);
    }
  }
}

TEST_P(DatasetRoundTrip, GivesBackTheImages) {
  std::vector<CameraFrame> expected = only<CameraFrame>(session_.messages);
  if (!GetParam().right_camera) std::erase_if(expected, [](const auto& frame) { return frame.camera_id != 0; });
  const auto found = only<CameraFrame>(read_);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].stamp_ns, expected[i].stamp_ns);
    EXPECT_EQ(found[i].camera_id, expected[i].camera_id);
    EXPECT_EQ(found[i].width, expected[i].width);
    EXPECT_EQ(found[i].pixels, expected[i].pixels);
  }
}

TEST_P(DatasetRoundTrip, GivesBackTheDepth) {
  const auto expected = only<DepthFrame>(session_.messages);
  const auto found = only<DepthFrame>(read_);
  ASSERT_EQ(found.size(), GetParam().depth ? expected.size() : 0);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].stamp_ns, expected[i].stamp_ns);
    EXPECT_EQ(found[i].camera_id, expected[i].camera_id);
    for (std::size_t k = 0; k < found[i].depth_m.size(); ++k) {
      EXPECT_NEAR(found[i].depth_m[k], expected[i].depth_m[k], 0.5 * GetParam().depth_step_m + 1e-6);
    }
  }
}

TEST_P(DatasetRoundTrip, GivesBackTheScans) {
  const auto expected = only<LidarScan>(session_.messages);
  const auto found = only<LidarScan>(read_);
  ASSERT_EQ(found.size(), GetParam().lidar ? expected.size() : 0);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].stamp_ns, expected[i].stamp_ns);
    if (GetParam().exact_scan_end) {
      EXPECT_EQ(found[i].end_ns, expected[i].end_ns);
      EXPECT_EQ(found[i].sweep, expected[i].sweep);
    }
    ASSERT_EQ(found[i].points.size(), expected[i].points.size());
    for (std::size_t k = 0; k < found[i].points.size(); ++k) {
      const LidarPoint& point = found[i].points[k];
      EXPECT_EQ(point.position, expected[i].points[k].position);
      EXPECT_EQ(point.ring, expected[i].points[k].ring);
      EXPECT_EQ(point.intensity, expected[i].points[k].intensity);
      EXPECT_NEAR(point.offset_ns, expected[i].points[k].offset_ns, static_cast<double>(GetParam().time_step_ns));
    }
  }
}

TEST_P(DatasetRoundTrip, GivesBackCalibrationAndTruth) {
  EXPECT_EQ(calibration_yaml(dataset_.calibration), calibration_yaml(synthetic_calibration()));
  ASSERT_FALSE(dataset_.recording.truth.empty());
  // KITTI's poses are relative to the first one, and at the middles of the sweeps.
  const bool relative = std::string(GetParam().name) == "kitti";
  std::optional<Pose> world_from_found;
  for (const auto& [stamp_ns, pose] : dataset_.recording.truth) {
    const auto same_time = std::find_if(session_.truth.begin(), session_.truth.end(),
                                        [&, at = stamp_ns](const auto& stamped) { return stamped.stamp_ns == at; });
    ASSERT_NE(same_time, session_.truth.end());
    if (!world_from_found) world_from_found = relative ? same_time->pose * pose.inverse() : Pose{};
    const Vector6d error = same_time->pose.local(*world_from_found * pose);
    EXPECT_LT(error.norm(), 1e-8);  // TUM's text has nine decimals
  }
}

TEST_P(DatasetRoundTrip, DeliversInOrder) {
  for (std::size_t i = 1; i < read_.size(); ++i) EXPECT_LE(read_[i - 1].delivery_ns, read_[i].delivery_ns);
}

INSTANTIATE_TEST_SUITE_P(Formats, DatasetRoundTrip, testing::ValuesIn(kCases),
                         [](const auto& format) { return std::string(format.param.name); });

TEST(PlumblineDataset, GivesBackEveryBit) {
  const TemporaryDirectory directory;
  const SyntheticSession session = synthetic_session();
  const auto writer = make_dataset_writer("plumbline", directory.path(), synthetic_calibration());
  for (const SensorMessage& message : session.messages) writer->write(message);
  writer->finish({});
  const Dataset dataset = open_dataset("plumbline", directory.path(), {});
  const auto read = drained(dataset.recording.messages);
  ASSERT_EQ(read.size(), session.messages.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].delivery_ns, session.messages[i].delivery_ns);
    EXPECT_EQ(read[i].payload.index(), session.messages[i].payload.index());
  }
  EXPECT_TRUE(dataset.recording.truth.empty());
}

TEST(DatasetSettings, CalibrationKeysAreLaidOverTheDatasets) {
  const TemporaryDirectory directory;
  make_dataset_writer("plumbline", directory.path(), synthetic_calibration())->finish({});
  DatasetSettings settings;
  settings.lidar_model = "hdl64e";
  settings.calibration = read_yaml_text("lidar: {range_sigma_m: 0.123}", "--set", {});
  const Calibration calibration = open_dataset("plumbline", directory.path(), settings).calibration;
  EXPECT_EQ(calibration.lidar_range_sigma_m, 0.123);
  EXPECT_EQ(calibration.lidar_rings, 64);
  settings.calibration = read_yaml_text("lidar: {range_sigma: 0.123}", "--set", {});
  EXPECT_THROW(open_dataset("plumbline", directory.path(), settings), InputError);
}

}  // namespace
}  // namespace plumbline
