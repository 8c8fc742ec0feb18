#include "tools/formats/tum_rgbd.h"

#include <algorithm>
#include <cmath>

#include "scenarios/calibration.h"
#include "scenarios/input_error.h"
#include "scenarios/merged_source.h"
#include "tools/formats/clock_source.h"
#include "tools/formats/dataset_calibration.h"
#include "tools/formats/image_file.h"
#include "tools/formats/number_text.h"
#include "tools/formats/output_file.h"
#include "tools/formats/recorded_files.h"
#include "tools/formats/text_table.h"
#include "tools/formats/truth_file.h"
#include "tools/formats/tum.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr float kStepsPerMetre = 5000.0F;
constexpr float kMostSteps = 65535.0F;
constexpr CameraIntrinsics kKinect{640, 480, 525.0, 525.0, 319.5, 239.5, {}};
constexpr double kKinectRate_hz = 30.0;

std::vector<StampedFile> read_list(const fs::path& folder, const char* name) {
  std::vector<StampedFile> files;
  if (!fs::exists(folder / name)) return files;
  TextTable table(folder / name);
  while (table.next()) files.push_back({listed_file(folder, table.word(1)), table.seconds_as_ns(0)});
  return files;
}

std::vector<ImuSample> read_accelerometer(const fs::path& path) {
  std::vector<ImuSample> samples;
  if (!fs::exists(path)) return samples;
  TextTable table(path);
  while (table.next()) {
    ImuSample sample;
    sample.stamp_ns = table.seconds_as_ns(0);
    sample.specific_force = {table.number(1), table.number(2), table.number(3)};
    samples.push_back(sample);
  }
  return samples;
}

DepthFrame read_depth(const StampedFile& file, int camera_id) {
  const DepthImage image = read_depth_image(file.path);
  DepthFrame frame{file.stamp_ns, camera_id, image.width, image.height, {}};
  frame.depth_m.reserve(image.values.size());
  for (const std::uint16_t steps : image.values) frame.depth_m.push_back(static_cast<float>(steps) / kStepsPerMetre);
  return frame;
}

/// A Kinect with its depth registered to the colour image.
Calibration kinect(double imu_rate_hz) {
  Calibration calibration;
  calibration.imu_rate_hz = imu_rate_hz;
  calibration.has_lidar = false;
  calibration.camera = kKinect;
  calibration.camera_rate_hz = kKinectRate_hz;
  calibration.body_from_camera = {body_from_optical_rotation(), Eigen::Vector3d::Zero()};
  calibration.further_cameras.push_back({kDepthCamera, calibration.body_from_camera, kKinect, kKinectRate_hz});
  return calibration;
}

std::vector<PoseTrack::Stamped> body_of_camera(std::vector<PoseTrack::Stamped> poses, const Pose& body_from_camera) {
  for (auto& stamped : poses) stamped.pose = stamped.pose * body_from_camera.inverse();
  return poses;
}

class TumWriter final : public DatasetWriter {
 public:
  TumWriter(const fs::path& directory, const Calibration& calibration)
      : directory_(directory), body_from_camera_(calibration.body_from_camera) {
    fs::create_directory(directory / "rgb");
    fs::create_directory(directory / "depth");
    rgb_.write("# timestamp filename\n");
    depth_.write("# timestamp filename\n");
    accelerometer_.write("# timestamp ax ay az\n");
  }

  void write(const SensorMessage& message) override {
    std::visit([this](const auto& payload) { add(payload); }, message.payload);
  }

  void finish(const std::vector<PoseTrack::Stamped>& truth) override {
    for (OutputFile* file : {&rgb_, &depth_, &accelerometer_}) file->close();
    if (truth.empty()) return;
    write_whole_file(directory_ / "groundtruth.txt", tum_text(body_of_camera(truth, body_from_camera_.inverse())));
  }

 private:
  void add(const ImuSample& sample) {
    std::string row;
    append_seconds(row, sample.stamp_ns);
    for (const double value : sample.specific_force) append_general(row += ' ', value, 17);
    accelerometer_.write(row += '\n');
  }

  void add(const CameraFrame& frame) {
    if (frame.camera_id == kMainCamera) write_grey_image(listed(rgb_, "rgb", frame.stamp_ns), frame);
  }

  void add(const DepthFrame& frame) {
    DepthImage image{frame.width, frame.height, {}};
    image.values.reserve(frame.depth_m.size());
    for (const float depth_m : frame.depth_m) {
      const float steps = std::round(depth_m * kStepsPerMetre);
      image.values.push_back(steps > 0.0F && steps <= kMostSteps ? static_cast<std::uint16_t>(steps) : 0);
    }
    write_depth_image(listed(depth_, "depth", frame.stamp_ns), image);
  }

  void add(const LidarScan&) {}  // the format has none

  /// Adds an image to its list and says where it goes.
  fs::path listed(OutputFile& list, const std::string& folder, std::int64_t stamp_ns) {
    std::string stamp;
    append_seconds(stamp, stamp_ns);
    const std::string name = folder + "/" + stamp + ".png";
    list.write(stamp + " " + name + "\n");
    return directory_ / name;
  }

  fs::path directory_;
  Pose body_from_camera_;
  OutputFile rgb_{directory_ / "rgb.txt"};
  OutputFile depth_{directory_ / "depth.txt"};
  OutputFile accelerometer_{directory_ / "accelerometer.txt"};
};

}  // namespace

Dataset open_tum_rgbd(const fs::path& path, const DatasetSettings& settings) {
  const std::vector<StampedFile> images = read_list(path, "rgb.txt");
  const std::vector<StampedFile> depths = read_list(path, "depth.txt");
  const std::vector<ImuSample> samples = read_accelerometer(path / "accelerometer.txt");
  if (images.empty()) throw InputError(path.string() + ": holds no rgb.txt, or an empty one");

  Dataset dataset;
  dataset.has_imu = false;
  dataset.calibration =
      complete_calibration(kinect(samples.empty() ? settings.clock_hz : rate_of(samples)), path, settings);
  const auto& further = dataset.calibration.further_cameras;
  const int depth_id = further.empty() ? kDepthCamera : further.back().camera_id;
  MessageSource pictures =
      merged_sources(frame_source(images, kMainCamera),
                     file_source(depths, [depth_id](const StampedFile& file) { return read_depth(file, depth_id); }));
  dataset.recording.messages = samples.empty() ? with_clock(std::move(pictures), settings.clock_hz)
                                               : merged_sources(imu_source(samples), std::move(pictures));
  const fs::path truth = settings.truth.empty() ? path / "groundtruth.txt" : settings.truth;
  if (fs::exists(truth)) {
    dataset.recording.truth = body_of_camera(read_truth_file(truth), dataset.calibration.body_from_camera);
  }
  dataset.recording.start_ns = images.front().stamp_ns;
  dataset.recording.end_ns = images.back().stamp_ns;
  return dataset;
}

std::unique_ptr<DatasetWriter> make_tum_rgbd_writer(const fs::path& directory, const Calibration& calibration) {
  return std::make_unique<TumWriter>(directory, calibration);
}

}  // namespace plumbline
