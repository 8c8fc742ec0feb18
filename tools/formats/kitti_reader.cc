#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "scenarios/input_error.h"
#include "scenarios/merged_source.h"
#include "tools/formats/clock_source.h"
#include "tools/formats/dataset_calibration.h"
#include "tools/formats/image_file.h"
#include "tools/formats/kitti.h"
#include "tools/formats/kitti_calibration.h"
#include "tools/formats/kitti_folder.h"
#include "tools/formats/kitti_points.h"
#include "tools/formats/text_table.h"
#include "tools/formats/truth_file.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKittiLidar = "hdl64e";
constexpr std::uintmax_t kMostSideFileBytes = std::uintmax_t{64} << 20;

// Calibration.

using Keys = std::map<std::string, std::vector<double>>;

const std::vector<double>& value_of(const Keys& keys, const std::string& key, std::size_t count, const fs::path& file) {
  const auto found = keys.find(key);
  if (found != keys.end() && found->second.size() == count) return found->second;
  throw InputError(file.string() + ": " + key + ": expected " + std::to_string(count) + " numbers");
}

/// Of a rotation's nine numbers and a translation's three.
Pose pose_of_parts(const std::vector<double>& rotation, const std::vector<double>& translation, const fs::path& file) {
  std::vector<double> rows;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) rows.push_back(rotation[3 * row + column]);
    rows.push_back(translation[row]);
  }
  return kitti_pose(rows, file.string());
}

/// A file of keys R and T.
Pose read_transform(const fs::path& file) {
  const Keys keys = read_kitti_keys(file);
  return pose_of_parts(value_of(keys, "R", 9, file), value_of(keys, "T", 3, file), file);
}

Pose lidar_from_imu(const KittiFolder& folder) {
  const fs::path file = folder.calibration_file("calib_imu_to_velo.txt");
  return file.empty() ? Pose{} : read_transform(file);
}

/// Projection matrices of cameras 0 and 1, and where camera 0 is.
struct Rectified {
  std::vector<double> projection[2];
  Pose camera_from_lidar;
};

std::optional<Rectified> read_rectified(const KittiFolder& folder) {
  const fs::path odometry = folder.path / "calib.txt";
  if (fs::exists(odometry)) {
    const Keys keys = read_kitti_keys(odometry);
    const char* name = keys.count("Tr") != 0 ? "Tr" : "Tr_velo_to_cam";
    return Rectified{{value_of(keys, "P0", 12, odometry), value_of(keys, "P1", 12, odometry)},
                     kitti_pose(value_of(keys, name, 12, odometry), odometry.string() + ": " + name)};
  }
  const fs::path cameras = folder.calibration_file("calib_cam_to_cam.txt");
  const fs::path lidar = folder.calibration_file("calib_velo_to_cam.txt");
  if (cameras.empty() || lidar.empty()) return std::nullopt;
  const Keys keys = read_kitti_keys(cameras);
  const Pose rectified_from_camera = pose_of_parts(value_of(keys, "R_rect_00", 9, cameras), {0.0, 0.0, 0.0}, cameras);
  return Rectified{{value_of(keys, "P_rect_00", 12, cameras), value_of(keys, "P_rect_01", 12, cameras)},
                   rectified_from_camera * read_transform(lidar)};
}

void take_camera(const KittiFolder& folder, int camera, const Rectified& rectified, const Pose& lidar_from_body,
                 Calibration& calibration) {
  const auto& images = folder.images[static_cast<std::size_t>(camera)];
  if (images.empty()) return;
  const std::vector<double>& p = rectified.projection[camera];
  if (!(p[0] > 0.0) || !(p[5] > 0.0)) {
    throw InputError(folder.path.string() + ": the calibration's P" + std::to_string(camera) +
                     " is no projection matrix");
  }
  const CameraFrame first = read_grey_image(images.front().path);
  const CameraIntrinsics intrinsics{first.width, first.height, p[0], p[5], p[2], p[6], {}};
  // P = K [I t]: the point of camera 0 moved by t.
  const Pose camera_from_zero{Eigen::Quaterniond::Identity(), {p[3] / p[0], 0.0, 0.0}};
  const Pose body_from_camera = (camera_from_zero * rectified.camera_from_lidar * lidar_from_body).inverse();
  if (camera > 0) {
    calibration.further_cameras.push_back({camera, body_from_camera, intrinsics, calibration.camera_rate_hz});
    return;
  }
  calibration.has_camera = true;
  calibration.camera = intrinsics;
  calibration.body_from_camera = body_from_camera;
}

double rate_of(std::size_t count, std::int64_t span_ns) {
  constexpr double kUsual_hz = 10.0;
  return count > 1 && span_ns > 0 ? 1e9 * static_cast<double>(count - 1) / static_cast<double>(span_ns) : kUsual_hz;
}

Calibration native_calibration(const KittiFolder& folder, const DatasetSettings& settings) {
  Calibration calibration;
  calibration.imu_rate_hz = folder.imu.empty() ? settings.clock_hz : rate_of(folder.imu);
  calibration.has_lidar = !folder.scans.empty();
  if (calibration.has_lidar) {
    calibration.lidar_rate_hz = rate_of(folder.scans.size(), folder.scans.back().end_ns - folder.scans.front().end_ns);
  }
  const Pose lidar_from_body = folder.imu.empty() ? Pose{} : lidar_from_imu(folder);
  calibration.body_from_lidar = lidar_from_body.inverse();
  calibration.has_camera = false;
  const auto& images = folder.images[0];
  if (images.empty()) return calibration;
  calibration.camera_rate_hz = rate_of(images.size(), images.back().stamp_ns - images.front().stamp_ns);
  if (const auto rectified = read_rectified(folder)) {
    for (const int camera : {0, 1}) take_camera(folder, camera, *rectified, lidar_from_body, calibration);
  }
  return calibration;
}

// Truth.

std::vector<Pose> read_camera_poses(const fs::path& file) {
  std::vector<Pose> poses;
  TextTable table(file);
  while (table.next()) {
    std::vector<double> rows;
    for (std::size_t i = 0; i < table.size(); ++i) rows.push_back(table.number(i));
    poses.push_back(kitti_pose(rows, file.string()));
  }
  return poses;
}

Pose body_from_posed_camera(const KittiFolder& folder, const Calibration& calibration) {
  if (calibration.has_camera) return calibration.body_from_camera;
  if (const auto rectified = read_rectified(folder)) {
    return calibration.body_from_lidar * rectified->camera_from_lidar.inverse();
  }
  return calibration.body_from_lidar * Pose{body_from_optical_rotation(), Eigen::Vector3d::Zero()};
}

/// Poses of camera 0: one for each scan, or one for each number that a scan may have.
std::vector<PoseTrack::Stamped> truth_of_camera(const KittiFolder& folder, const fs::path& file,
                                                const Calibration& calibration) {
  const std::vector<Pose> poses = read_camera_poses(file);
  const bool one_each = poses.size() == folder.scans.size();
  const Pose body_from_camera = body_from_posed_camera(folder, calibration);
  std::vector<PoseTrack::Stamped> truth;
  for (std::size_t i = 0; i < folder.scans.size(); ++i) {
    const KittiScan& scan = folder.scans[i];
    const std::size_t row = one_each ? i : static_cast<std::size_t>(scan.number);
    const std::int64_t stamp_ns = folder.compensated ? scan.end_ns : scan.middle_ns();
    if (row >= poses.size()) {
      throw InputError(file.string() + ": found " + std::to_string(poses.size()) + " poses, none for scan " +
                       std::to_string(scan.number));
    }
    if (!truth.empty() && stamp_ns <= truth.back().stamp_ns) continue;
    truth.push_back({stamp_ns, body_from_camera * poses[row] * body_from_camera.inverse()});
  }
  return truth;
}

/// The IMU's poses, where its drive begins, as the body's.
std::vector<PoseTrack::Stamped> truth_of_oxts(const KittiFolder& folder, const Calibration& calibration) {
  std::vector<PoseTrack::Stamped> truth = folder.oxts_poses;
  if (truth.empty()) return truth;
  const Pose body_from_imu = folder.imu.empty() ? calibration.body_from_lidar * lidar_from_imu(folder) : Pose{};
  const Eigen::Vector3d start = truth.front().pose.translation;
  for (PoseTrack::Stamped& stamped : truth) {
    stamped.pose.translation -= start;
    stamped.pose = stamped.pose * body_from_imu.inverse();
  }
  return truth;
}

std::vector<PoseTrack::Stamped> read_truth(const KittiFolder& folder, const Calibration& calibration,
                                           const DatasetSettings& settings) {
  const std::string name = fs::weakly_canonical(folder.path).filename().string() + ".txt";
  const fs::path own = first_that_exists({folder.path / "poses.txt", folder.path / ".." / ".." / "poses" / name});
  const fs::path file = settings.truth.empty() ? own : settings.truth;
  if (file.empty()) return truth_of_oxts(folder, calibration);
  TextTable table(file);
  const bool is_kitti = table.next() && table.size() == 12;
  return is_kitti ? truth_of_camera(folder, file, calibration) : read_truth_file(file);
}

// Messages.

/// A file of one value for each point, if there is one.
template <typename Value>
std::vector<Value> read_side_file(const fs::path& path, std::size_t points) {
  if (!fs::exists(path)) return {};
  const std::string bytes = read_bounded_file(path, kMostSideFileBytes);
  if (bytes.size() != points * sizeof(Value)) {
    throw InputError(path.string() + ": found " + std::to_string(bytes.size()) + " bytes, expected " +
                     std::to_string(sizeof(Value)) + " for each of the scan's " + std::to_string(points) + " points");
  }
  std::vector<Value> values(points);
  if (points > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// A time that is none, or outside the scan, takes its point along.
void take_times(const std::vector<float>& times_s, std::int64_t span_ns, std::vector<LidarPoint>& points) {
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double offset_ns = std::round(1e9 * static_cast<double>(times_s[i]));
    if (offset_ns >= 0.0 && offset_ns <= static_cast<double>(span_ns)) {
      points[i].offset_ns = static_cast<std::int32_t>(offset_ns);
    } else {
      points[i].position.setZero();
    }
  }
}

LidarScan read_scan(const KittiScan& file, const fs::path& folder, bool compensated, int rings) {
  LidarScan scan{file.start_ns, file.end_ns, read_kitti_points(file.path), file.sweep, file.ends_sweep};
  const fs::path name = file.path.filename();
  const auto times_s = read_side_file<float>(folder / "times" / name, scan.points.size());
  const auto numbers = read_side_file<std::uint16_t>(folder / "rings" / name, scan.points.size());
  const std::int64_t span_ns = scan.end_ns - scan.stamp_ns;
  take_times(times_s, span_ns, scan.points);
  for (std::size_t i = 0; i < numbers.size(); ++i) scan.points[i].ring = numbers[i];
  drop_unusable(scan.points);
  if (numbers.empty()) assign_rings_by_azimuth(rings, scan.points);
  if (times_s.empty() && !compensated) assign_times_by_azimuth(span_ns, scan.points);
  sort_by_time(scan.points);
  return scan;
}

MessageSource scan_source(const KittiFolder& folder, int rings) {
  return [scans = folder.scans, path = folder.path, compensated = folder.compensated, rings, next = std::size_t{0},
          delivered_ns = INT64_MIN]() mutable -> std::unique_ptr<SensorMessage> {
    if (next == scans.size()) return nullptr;
    const KittiScan& scan = scans[next++];
    delivered_ns = std::max(delivered_ns, scan.end_ns);
    return timed_message([&] { return read_scan(scan, path, compensated, rings); }, delivered_ns);
  };
}

void take_span(const KittiFolder& folder, Recording& recording) {
  recording.start_ns = folder.scans.empty() ? folder.images[0].front().stamp_ns : folder.scans.front().start_ns;
  recording.end_ns = folder.scans.empty() ? folder.images[0].back().stamp_ns : folder.scans.back().end_ns;
}

}  // namespace

Dataset open_kitti(const fs::path& path, const DatasetSettings& settings) {
  const KittiFolder folder = read_kitti_folder(path, settings);
  DatasetSettings known = settings;
  if (known.lidar_model.empty() && !folder.is_ours) known.lidar_model = kKittiLidar;
  Dataset dataset;
  dataset.has_imu = !folder.imu.empty();
  dataset.calibration = complete_calibration(native_calibration(folder, settings), path, known);
  dataset.recording.truth = read_truth(folder, dataset.calibration, settings);
  take_span(folder, dataset.recording);
  MessageSource messages =
      merged_sources(merged_sources(frame_source(folder.images[0], 0), frame_source(folder.images[1], 1)),
                     scan_source(folder, dataset.calibration.lidar_rings));
  dataset.recording.messages = dataset.has_imu ? merged_sources(imu_source(folder.imu), std::move(messages))
                                               : with_clock(std::move(messages), settings.clock_hz);
  return dataset;
}

}  // namespace plumbline
