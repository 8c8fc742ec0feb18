#include <algorithm>
#include <array>

#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"
#include "scenarios/merged_source.h"
#include "scenarios/yaml_reader.h"
#include "tools/formats/dataset_calibration.h"
#include "tools/formats/euroc.h"
#include "tools/formats/image_file.h"
#include "tools/formats/kitti_calibration.h"
#include "tools/formats/recorded_files.h"
#include "tools/formats/text_table.h"
#include "tools/formats/truth_file.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr double kUnknownTurnOn = 0.05;  // [rad/s]; the format has no such figure, and uncalibrated MEMS err by 3 deg/s
constexpr std::uintmax_t kMostYamlBytes = 1'000'000;
constexpr const char* kSeparators = ", \t\r";
constexpr Range kAnything{-1e9, 1e9};
constexpr Range kPositiveInSensorFile{1e-9, 1e9};

/// A sensor.yaml. Its first line is a directive that only OpenCV writes without a space.
ConfigNode read_sensor_yaml(const fs::path& path) {
  std::string text = read_bounded_file(path, kMostYamlBytes);
  if (text.starts_with("%")) text.replace(0, std::min(text.find('\n'), text.size()), "");
  return read_yaml_text(text, path.string(), path.parent_path());
}

Pose pose_of_matrix(ConfigReader& sensor) {
  std::vector<double> matrix;
  if (const ConfigNode* node = sensor.find("T_BS")) {
    ConfigReader reader(*node, "T_BS");
    reader.read("data", matrix, kAnything);
  }
  if (matrix.size() != 16) throw InputError(sensor.node().where + ": T_BS.data: expected 16 numbers");
  matrix.resize(12);
  return kitti_pose(matrix, sensor.node().where + ": T_BS");
}

class EurocFolder {
 public:
  EurocFolder(const fs::path& path, const DatasetSettings& settings)
      : path_(path), root_(fs::is_directory(path / "mav0") ? path / "mav0" : path), settings_(settings) {
    read_imu();
    for (std::size_t camera = 0; camera < images_.size(); ++camera) find_images(camera);
    if (images_[0].empty() && imu_.empty()) throw InputError(path.string() + ": holds neither imu0 nor cam0");
  }

  Dataset open() {
    Dataset dataset;
    const Calibration native = calibration();
    for (ImuSample& sample : imu_) sample.stamp_ns += euroc_half_period_ns(native.imu_rate_hz);
    dataset.calibration = complete_calibration(native, path_, settings_);
    dataset.recording.truth = truth();
    dataset.recording.start_ns = imu_.empty() ? images_[0].front().stamp_ns : imu_.front().stamp_ns;
    dataset.recording.end_ns = imu_.empty() ? images_[0].back().stamp_ns : imu_.back().stamp_ns;
    dataset.recording.messages =
        merged_sources(imu_source(imu_), merged_sources(frame_source(images_[0], 0), frame_source(images_[1], 1)));
    return dataset;
  }

 private:
  void read_imu() {
    TextTable table(root_ / "imu0" / "data.csv", kSeparators);
    while (table.next()) {
      ImuSample sample;
      sample.stamp_ns = table.whole(0);
      for (std::size_t i = 0; i < 3; ++i) {
        sample.angular_rate[static_cast<int>(i)] = table.number(1 + i);
        sample.specific_force[static_cast<int>(i)] = table.number(4 + i);
      }
      imu_.push_back(sample);
    }
  }

  void find_images(std::size_t camera) {
    const fs::path folder = root_ / ("cam" + std::to_string(camera));
    const fs::path data = fs::is_directory(folder / "data") ? folder / "data" : folder;
    if (fs::exists(folder / "data.csv")) {
      TextTable table(folder / "data.csv", kSeparators);
      while (table.next()) images_[camera].push_back({listed_file(data, table.word(1)), table.whole(0)});
    } else {
      for (const NumberedFile& file : numbered_files(data, {".png"})) {
        images_[camera].push_back({file.path, file.number});
      }
    }
  }

  Calibration calibration() const {
    Calibration calibration;
    calibration.has_lidar = false;
    const Pose imu_from_body = read_imu_sheet(calibration).inverse();
    calibration.has_camera = !images_[0].empty();
    for (std::size_t camera = 0; camera < images_.size(); ++camera) {
      if (images_[camera].empty()) continue;
      FurtherCamera read = read_camera(camera);
      read.body_from_camera = imu_from_body * read.body_from_camera;
      if (camera > 0) {
        calibration.further_cameras.push_back(read);
        continue;
      }
      calibration.camera = read.intrinsics;
      calibration.body_from_camera = read.body_from_camera;
      calibration.camera_rate_hz = read.rate_hz;
    }
    return calibration;
  }

  Pose read_imu_sheet(Calibration& calibration) const {
    calibration.imu_rate_hz = std::max(1.0, rate_of(imu_));
    calibration.imu.gyro_turn_on_sigma = kUnknownTurnOn;
    const fs::path path = root_ / "imu0" / "sensor.yaml";
    if (!fs::exists(path)) return {};
    const ConfigNode node = read_sensor_yaml(path);
    ConfigReader sensor(node, "");
    sensor.read("rate_hz", calibration.imu_rate_hz, kPositiveInSensorFile);
    sensor.read("gyroscope_noise_density", calibration.imu.gyro_density, kPositiveInSensorFile);
    sensor.read("gyroscope_random_walk", calibration.imu.gyro_random_walk, kPositiveInSensorFile);
    sensor.read("accelerometer_noise_density", calibration.imu.accel_density, kPositiveInSensorFile);
    sensor.read("accelerometer_random_walk", calibration.imu.accel_random_walk, kPositiveInSensorFile);
    return pose_of_matrix(sensor);
  }

  FurtherCamera read_camera(std::size_t id) const {
    const fs::path path = root_ / ("cam" + std::to_string(id)) / "sensor.yaml";
    const ConfigNode node = read_sensor_yaml(path);
    ConfigReader sensor(node, "");
    FurtherCamera camera;
    camera.camera_id = static_cast<int>(id);
    camera.rate_hz = 20.0;
    sensor.read("rate_hz", camera.rate_hz, kPositiveInSensorFile);
    std::string model = "radial-tangential";
    sensor.read("distortion_model", model);
    std::vector<double> size, focal, lens;
    sensor.read("resolution", size, {1.0, kMostImageSide});
    sensor.read("intrinsics", focal, kAnything);
    sensor.read("distortion_coefficients", lens, kAnything);
    if (size.size() != 2 || focal.size() != 4 || lens.size() != 4 || model != "radial-tangential") {
      throw InputError(path.string() +
                       ": expected a resolution of two numbers, intrinsics of four and four radial-tangential "
                       "distortion_coefficients");
    }
    camera.intrinsics = {
        static_cast<int>(size[0]),           static_cast<int>(size[1]), focal[0], focal[1], focal[2], focal[3],
        {lens[0], lens[1], lens[2], lens[3]}};
    camera.body_from_camera = pose_of_matrix(sensor);
    return camera;
  }

  std::vector<PoseTrack::Stamped> truth() const {
    const fs::path own = root_ / "state_groundtruth_estimate0" / "data.csv";
    if (!settings_.truth.empty()) return read_truth_file(settings_.truth);
    return fs::exists(own) ? read_truth_file(own) : std::vector<PoseTrack::Stamped>{};
  }

  fs::path path_;
  fs::path root_;
  DatasetSettings settings_;
  std::vector<ImuSample> imu_;
  std::array<std::vector<StampedFile>, 2> images_;
};

}  // namespace

Dataset open_euroc(const fs::path& path, const DatasetSettings& settings) { return EurocFolder(path, settings).open(); }

}  // namespace plumbline
