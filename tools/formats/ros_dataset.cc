#include "tools/formats/ros_dataset.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "scenarios/calibration.h"
#include "scenarios/input_error.h"
#include "tools/formats/clock_source.h"
#include "tools/formats/dataset_calibration.h"
#include "tools/formats/ros_conversion.h"
#include "tools/formats/rosbag2_file.h"
#include "tools/formats/rosbag_file.h"
#include "tools/formats/truth_file.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBagName = "data.bag";

using OpenBag = std::function<RosSource(const std::set<std::string>& topics)>;

/// What the bags' own readers throw is about the file.
template <typename Call>
auto about_input(Call call) {
  try {
    return call();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(error.what());
  }
}

/// A bag's messages as a session's.
class BagMessages {
 public:
  BagMessages(RosSource source, RosTopics topics, int depth_camera, std::string path)
      : source_(std::move(source)), topics_(std::move(topics)), depth_camera_(depth_camera), path_(std::move(path)) {}

  std::unique_ptr<SensorMessage> next() {
    while (auto message = about_input([&] { return source_(); })) {
      delivered_ns_ = std::max(delivered_ns_, message->time_ns);
      try {
        if (auto payload = converted(*message)) {
          return std::make_unique<SensorMessage>(SensorMessage{std::move(*payload), delivered_ns_, 0.0, {}});
        }
      } catch (const std::invalid_argument& error) {
        throw InputError(path_ + ": " + message->topic + ": " + error.what());
      }
    }
    return nullptr;
  }

 private:
  std::optional<SensorPayload> converted(const RosMessage& message) const {
    const RosPayload& payload = message.payload;
    if (const auto* sample = std::get_if<ImuSample>(&payload)) {
      return message.topic == topics_.imu ? std::optional<SensorPayload>(*sample) : std::nullopt;
    }
    if (const auto* cloud = std::get_if<RosPointCloud>(&payload)) {
      return message.topic == topics_.lidar ? std::optional<SensorPayload>(scan_of(*cloud)) : std::nullopt;
    }
    const auto* image = std::get_if<RosImage>(&payload);
    if (image == nullptr) return std::nullopt;
    if (message.topic == topics_.camera) return frame_of(*image, kMainCamera);
    if (message.topic == topics_.right_camera) return frame_of(*image, kRightCamera);
    if (message.topic == topics_.depth) return depth_of(*image, depth_camera_);
    return std::nullopt;
  }

  RosSource source_;
  RosTopics topics_;
  int depth_camera_;
  std::string path_;
  std::int64_t delivered_ns_ = INT64_MIN;
};

std::vector<PoseTrack::Stamped> read_truth(const OpenBag& open, const std::string& topic) {
  std::vector<PoseTrack::Stamped> truth;
  const RosSource source = open({topic});
  while (const auto message = source()) {
    const auto* pose = std::get_if<PoseTrack::Stamped>(&message->payload);
    if (pose == nullptr) continue;
    const bool later = truth.empty() || pose->stamp_ns > truth.back().stamp_ns;
    const double norm = pose->pose.rotation.norm();
    if (!later || !pose->pose.translation.allFinite() || !(std::abs(norm - 1.0) < kQuaternionTolerance)) continue;
    truth.push_back(*pose);
    // One that is as near as rounding allows is left as it was written.
    if (std::abs(norm - 1.0) > 1e-12) truth.back().pose.rotation.normalize();
  }
  return truth;
}

Dataset open_bag(const OpenBag& open, const fs::path& path, const fs::path& folder, const DatasetSettings& settings) {
  const RosTopics& topics = settings.topics;
  const auto holds = [&](const std::string& topic) { return about_input([&] { return open({topic})().has_value(); }); };
  Dataset dataset;
  dataset.has_imu = holds(topics.imu);
  Calibration native;
  native.has_camera = holds(topics.camera);
  native.has_lidar = holds(topics.lidar);
  if (!dataset.has_imu && !native.has_camera && !native.has_lidar) {
    throw InputError(path.string() + ": holds none of the topics " + topics.imu + ", " + topics.camera + ", " +
                     topics.lidar + "; dataset.topics names others");
  }
  if (!dataset.has_imu) native.imu_rate_hz = settings.clock_hz;
  dataset.calibration = complete_calibration(native, folder, settings);
  dataset.recording.truth = settings.truth.empty() ? about_input([&] { return read_truth(open, topics.truth); })
                                                   : read_truth_file(settings.truth);
  const auto& further = dataset.calibration.further_cameras;
  const bool has_depth_camera = !further.empty() && further.back().camera_id >= kDepthCamera;
  auto messages = std::make_shared<BagMessages>(
      about_input([&] {
        return open({topics.imu, topics.camera, topics.right_camera, topics.depth, topics.lidar});
      }),
      topics, has_depth_camera ? further.back().camera_id : kDepthCamera, path.string());
  dataset.recording.messages = [messages] { return messages->next(); };
  if (!dataset.has_imu) {
    dataset.recording.messages = with_clock(std::move(dataset.recording.messages), settings.clock_hz);
  }
  return dataset;
}

fs::path bag_in(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return path;
  if (fs::exists(path / kBagName)) return path / kBagName;
  for (const auto& entry : fs::directory_iterator(path)) {
    if (entry.path().extension() == ".bag") return entry.path();
  }
  throw InputError(path.string() + ": holds no .bag file");
}

class RosDatasetWriter final : public DatasetWriter {
 public:
  explicit RosDatasetWriter(std::unique_ptr<RosSink> sink) : sink_(std::move(sink)) {}

  /// Bags keep the order of recording by time alone: messages of one time are recorded a nanosecond apart.
  void write(const SensorMessage& message) override {
    recorded_ns_ = std::max(message.delivery_ns, recorded_ns_ + 1);
    std::visit(
        [&](const auto& payload) {
          sink_->write({topic_of(payload), recorded_ns_, ros(payload)});
        },
        message.payload);
  }

  void finish(const std::vector<PoseTrack::Stamped>& truth) override {
    for (const PoseTrack::Stamped& stamped : truth) sink_->write({topics_.truth, stamped.stamp_ns, stamped});
    sink_->close();
  }

 private:
  std::string topic_of(const ImuSample&) const { return topics_.imu; }
  std::string topic_of(const LidarScan&) const { return topics_.lidar; }
  std::string topic_of(const DepthFrame&) const { return topics_.depth; }
  std::string topic_of(const CameraFrame& frame) const {
    return frame.camera_id == kMainCamera ? topics_.camera : topics_.right_camera;
  }

  static RosPayload ros(const ImuSample& sample) { return sample; }
  static RosPayload ros(const LidarScan& scan) { return cloud_of(scan); }
  static RosPayload ros(const DepthFrame& frame) { return image_of(frame); }
  static RosPayload ros(const CameraFrame& frame) { return image_of(frame); }

  RosTopics topics_;
  std::unique_ptr<RosSink> sink_;
  std::int64_t recorded_ns_ = 0;
};

}  // namespace

Dataset open_rosbag(const fs::path& path, const DatasetSettings& settings) {
  const fs::path bag = bag_in(path);
  if (!fs::is_regular_file(bag)) throw InputError(bag.string() + ": no such file");
  const OpenBag open = [bag](const std::set<std::string>& topics) { return open_rosbag_file(bag, topics); };
  return open_bag(open, bag, bag.parent_path(), settings);
}

Dataset open_rosbag2(const fs::path& path, const DatasetSettings& settings) {
  if (!fs::exists(path)) throw InputError(path.string() + ": no such file");
  const OpenBag open = [path](const std::set<std::string>& topics) { return open_rosbag2_file(path, topics); };
  return open_bag(open, path, fs::is_directory(path) ? path : path.parent_path(), settings);
}

std::unique_ptr<DatasetWriter> make_rosbag_writer(const fs::path& directory, const Calibration&) {
  return std::make_unique<RosDatasetWriter>(make_rosbag_file(directory / kBagName));
}

std::unique_ptr<DatasetWriter> make_rosbag2_writer(const fs::path& directory, const Calibration&) {
  return std::make_unique<RosDatasetWriter>(make_rosbag2_file(directory));
}

}  // namespace plumbline
