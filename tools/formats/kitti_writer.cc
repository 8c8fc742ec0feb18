#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>

#include "tools/evaluation/pairing.h"
#include "tools/formats/image_file.h"
#include "tools/formats/kitti.h"
#include "tools/formats/kitti_calibration.h"
#include "tools/formats/kitti_points.h"
#include "tools/formats/number_text.h"
#include "tools/formats/output_file.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

std::string numbered(std::int64_t number, const char* extension) {
  char name[32];
  std::snprintf(name, sizeof(name), "%06lld", static_cast<long long>(number));
  return std::string(name) + extension;
}

template <typename Value>
std::string bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

/// K [I | K^-1 t]: what a camera sees of the points of camera 0's frame. KITTI's pictures have no distortion; ours do,
/// and calibration.yaml says which.
std::string projection_text(const CameraIntrinsics& camera, const Eigen::Vector3d& shift) {
  std::string text;
  const double rows[3][4] = {{camera.fx, 0.0, camera.cx, camera.fx * shift.x()},
                             {0.0, camera.fy, camera.cy, camera.fy * shift.y()},
                             {0.0, 0.0, 1.0, shift.z()}};
  for (const auto& row : rows) {
    for (const double value : row) append_general(text += ' ', value, 17);
  }
  return text;
}

class KittiWriter final : public DatasetWriter {
 public:
  KittiWriter(const fs::path& directory, const Calibration& calibration)
      : directory_(directory), calibration_(calibration) {
    if (calibration.has_camera)
      body_from_camera_ = calibration.body_from_camera;
    else
      body_from_camera_ = calibration.body_from_lidar * Pose{body_from_optical_rotation(), Eigen::Vector3d::Zero()};
    for (const char* folder : {"velodyne", "times", "rings"}) fs::create_directory(directory_ / folder);
    write_calibration();
  }

  void write(const SensorMessage& message) override {
    std::visit([this](const auto& payload) { add(payload); }, message.payload);
  }

  void finish(const std::vector<PoseTrack::Stamped>& truth) override {
    std::string poses;
    std::string times;
    std::optional<Pose> camera_from_world;
    for (const std::int64_t middle_ns : middles_ns_) {
      append_seconds(times, middle_ns);
      times += '\n';
      if (truth.empty()) continue;
      const Pose world_from_camera = pose_at(truth, middle_ns) * body_from_camera_;
      if (!camera_from_world) camera_from_world = world_from_camera.inverse();
      poses += kitti_pose_text(*camera_from_world * world_from_camera) + "\n";
    }
    write_whole_file(directory_ / "times.txt", times);
    if (!truth.empty()) write_whole_file(directory_ / "poses.txt", poses);
    scans_.close();
    imu_.close();
    for (auto& [camera, images] : images_) images.times.close();
  }

 private:
  struct Images {
    OutputFile times;
    std::int64_t count = 0;
  };

  void write_calibration() {
    const CameraIntrinsics& main = calibration_.camera;
    std::string text;
    for (int camera = 0; camera < 4; ++camera) {
      const auto& others = calibration_.further_cameras;
      const auto other =
          std::find_if(others.begin(), others.end(), [&](const auto& c) { return c.camera_id == camera; });
      const bool known = camera > 0 && camera < 2 && other != others.end();
      const Eigen::Vector3d shift =
          known ? (other->body_from_camera.inverse() * body_from_camera_).translation : Eigen::Vector3d::Zero().eval();
      text += "P" + std::to_string(camera) + ":" + projection_text(known ? other->intrinsics : main, shift) + "\n";
    }
    const Pose camera_from_lidar = body_from_camera_.inverse() * calibration_.body_from_lidar;
    text += "Tr: " + kitti_pose_text(camera_from_lidar) + "\n";
    write_whole_file(directory_ / "calib.txt", text);
  }

  void add(const ImuSample& sample) {
    std::string row;
    append_seconds(row, sample.stamp_ns);
    for (const double value : sample.angular_rate) append_general(row += ' ', value, 17);
    for (const double value : sample.specific_force) append_general(row += ' ', value, 17);
    imu_.write(row += '\n');
  }

  void add(const CameraFrame& frame) {
    const std::string name = "image_" + std::to_string(frame.camera_id);
    auto images = images_.find(frame.camera_id);
    if (images == images_.end()) {
      fs::create_directory(directory_ / name);
      images = images_.emplace(frame.camera_id, Images{OutputFile(directory_ / (name + "_times.txt"))}).first;
    }
    write_grey_image(directory_ / name / numbered(images->second.count++, ".png"), frame);
    std::string row;
    append_seconds(row, frame.stamp_ns);
    images->second.times.write(row += '\n');
  }

  void add(const DepthFrame&) {}  // KITTI has none

  void add(const LidarScan& scan) {
    std::vector<LidarPoint> points = scan.points;
    sort_as_kitti(points);
    std::vector<float> times_s;
    std::vector<std::uint16_t> rings;
    for (const LidarPoint& point : points) {
      times_s.push_back(static_cast<float>(1e-9 * point.offset_ns));
      rings.push_back(point.ring);
    }
    const std::string name = numbered(static_cast<std::int64_t>(middles_ns_.size()), ".bin");
    write_whole_file(directory_ / "velodyne" / name, kitti_bin(points));
    write_whole_file(directory_ / "times" / name, bytes_of(times_s));
    write_whole_file(directory_ / "rings" / name, bytes_of(rings));
    std::string row;
    append_seconds(row, scan.stamp_ns);
    append_seconds(row += ' ', scan.end_ns);
    row += ' ' + std::to_string(scan.sweep) + (scan.ends_sweep ? " 1\n" : " 0\n");
    scans_.write(row);
    middles_ns_.push_back(scan.stamp_ns + (scan.end_ns - scan.stamp_ns) / 2);
  }

  fs::path directory_;
  Calibration calibration_;
  Pose body_from_camera_;
  OutputFile scans_{directory_ / "scans.txt"};
  OutputFile imu_{directory_ / "imu.txt"};
  std::map<int, Images> images_;
  std::vector<std::int64_t> middles_ns_;
};

}  // namespace

std::unique_ptr<DatasetWriter> make_kitti_writer(const fs::path& directory, const Calibration& calibration) {
  return std::make_unique<KittiWriter>(directory, calibration);
}

}  // namespace plumbline
