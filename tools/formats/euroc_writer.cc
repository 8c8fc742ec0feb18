#include <algorithm>
#include <array>
#include <map>

#include "tools/formats/euroc.h"
#include "tools/formats/image_file.h"
#include "tools/formats/number_text.h"
#include "tools/formats/output_file.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr int kDigits = 17;  // give back a double

template <typename Values>
void append_values(std::string& text, const Values& values) {
  for (const double value : values) append_general(text += ',', value, kDigits);
}

std::string matrix_yaml(const Pose& pose) {
  std::string text = "T_BS:\n  cols: 4\n  rows: 4\n  data: [";
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) append_general(text, rotation(row, column), kDigits), text += ", ";
    append_general(text, pose.translation[row], kDigits);
    text += ", ";
  }
  return text + "0.0, 0.0, 0.0, 1.0]\n";
}

std::string list_yaml(const char* key, std::initializer_list<double> values) {
  std::string text = std::string(key) + ": [";
  for (const double value : values) {
    if (text.back() != '[') text += ", ";
    append_general(text, value, kDigits);
  }
  return text + "]\n";
}

std::string number_yaml(const char* key, double value) {
  std::string text = std::string(key) + ": ";
  append_general(text, value, kDigits);
  return text + "\n";
}

class EurocWriter final : public DatasetWriter {
 public:
  EurocWriter(const fs::path& directory, const Calibration& calibration)
      : root_(directory / "mav0"),
        half_period_ns_(euroc_half_period_ns(calibration.imu_rate_hz)),
        imu_(csv("imu0",
                 "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],"
                 "w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],"
                 "a_RS_S_z [m s^-2]\n")) {
    const ImuNoise& noise = calibration.imu;
    write_whole_file(root_ / "imu0" / "sensor.yaml",
                     "sensor_type: imu\n" + matrix_yaml({}) + number_yaml("rate_hz", calibration.imu_rate_hz) +
                         number_yaml("gyroscope_noise_density", noise.gyro_density) +
                         number_yaml("gyroscope_random_walk", noise.gyro_random_walk) +
                         number_yaml("accelerometer_noise_density", noise.accel_density) +
                         number_yaml("accelerometer_random_walk", noise.accel_random_walk));
    if (calibration.has_camera) {
      add_camera({0, calibration.body_from_camera, calibration.camera, calibration.camera_rate_hz});
    }
    for (const FurtherCamera& camera : calibration.further_cameras) {
      if (camera.camera_id == 1) add_camera(camera);
    }
  }

  void write(const SensorMessage& message) override {
    std::visit([this](const auto& payload) { add(payload); }, message.payload);
  }

  void finish(const std::vector<PoseTrack::Stamped>& truth) override {
    imu_.close();
    for (auto& [camera, list] : cameras_) list.close();
    if (!truth.empty()) write_truth(truth);
  }

 private:
  OutputFile csv(const std::string& sensor, const char* header) {
    fs::create_directories(root_ / sensor);
    OutputFile file(root_ / sensor / "data.csv");
    file.write(header);
    return file;
  }

  void add_camera(const FurtherCamera& camera) {
    const std::string name = "cam" + std::to_string(camera.camera_id);
    cameras_.emplace(camera.camera_id, csv(name, "#timestamp [ns],filename\n"));
    fs::create_directory(root_ / name / "data");
    const CameraIntrinsics& k = camera.intrinsics;
    const LensDistortion& lens = k.distortion;
    write_whole_file(root_ / name / "sensor.yaml",
                     "sensor_type: camera\n" + matrix_yaml(camera.body_from_camera) +
                         number_yaml("rate_hz", camera.rate_hz) + "resolution: [" + std::to_string(k.width) + ", " +
                         std::to_string(k.height) + "]\ncamera_model: pinhole\n" +
                         list_yaml("intrinsics", {k.fx, k.fy, k.cx, k.cy}) + "distortion_model: radial-tangential\n" +
                         list_yaml("distortion_coefficients", {lens.k1, lens.k2, lens.p1, lens.p2}));
  }

  void add(const ImuSample& sample) {
    std::string row = std::to_string(sample.stamp_ns - half_period_ns_);
    append_values(row, sample.angular_rate);
    append_values(row, sample.specific_force);
    imu_.write(row += '\n');
  }

  void add(const CameraFrame& frame) {
    const auto list = cameras_.find(frame.camera_id);
    if (list == cameras_.end()) return;
    const std::string stamp = std::to_string(frame.stamp_ns);
    write_grey_image(root_ / ("cam" + std::to_string(frame.camera_id)) / "data" / (stamp + ".png"), frame);
    list->second.write(stamp + "," + stamp + ".png\n");
  }

  // The format has neither.
  void add(const DepthFrame&) {}
  void add(const LidarScan&) {}

  /// Velocities are the slopes between the poses; the biases, which belong to EuRoC's own estimate, are zero.
  void write_truth(const std::vector<PoseTrack::Stamped>& truth) {
    OutputFile file = csv("state_groundtruth_estimate0",
                          "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
                          "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], "
                          "b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
                          "b_a_RS_S_z [m s^-2]\n");
    write_whole_file(root_ / "state_groundtruth_estimate0" / "sensor.yaml",
                     "sensor_type: visual-inertial\n" + matrix_yaml({}));
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto& before = truth[i > 0 ? i - 1 : 0];
      const auto& after = truth[std::min(i + 1, truth.size() - 1)];
      const double span_s = seconds_between(before.stamp_ns, after.stamp_ns);
      Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
      if (span_s > 0.0) velocity = (after.pose.translation - before.pose.translation) / span_s;
      const Pose& pose = truth[i].pose;
      std::string row = std::to_string(truth[i].stamp_ns);
      append_values(row, pose.translation);
      append_values(row, std::array{pose.rotation.w(), pose.rotation.x(), pose.rotation.y(), pose.rotation.z()});
      append_values(row, velocity);
      row += ",0,0,0,0,0,0\n";
      file.write(row);
    }
    file.close();
  }

  fs::path root_;
  std::int64_t half_period_ns_;
  OutputFile imu_;
  std::map<int, OutputFile> cameras_;
};

}  // namespace

std::unique_ptr<DatasetWriter> make_euroc_writer(const fs::path& directory, const Calibration& calibration) {
  return std::make_unique<EurocWriter>(directory, calibration);
}

}  // namespace plumbline
