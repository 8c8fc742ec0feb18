#include "tools/recordings/lidar_steps.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/estimator.h"
#include "scenarios/input_error.h"
#include "scenarios/session.h"
#include "sim/constants.h"
#include "tools/evaluation/pairing.h"
#include "tools/formats/dataset.h"
#include "tools/formats/kitti_calibration.h"
#include "tools/formats/number_text.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStepsFile = "icp_relative_check.txt";

struct Step {
  std::int64_t scan = 0;  ///< its number; the step leads to it from the scan before
  Pose before_from_scan;
};

/// The sweeps' ends by scan, and the estimate.
struct LidarRun {
  std::vector<std::int64_t> numbers;
  std::vector<std::int64_t> ends_ns;
  StampedPoses estimate;

  /// How the estimate moved to the i-th scan from the one before.
  Pose step(std::size_t i) const { return pose_at(estimate, ends_ns[i - 1]).inverse() * pose_at(estimate, ends_ns[i]); }
};

LidarRun run_lidar(const fs::path& folder, PointTimes point_times) {
  DatasetSettings settings;
  settings.point_times = point_times;
  Dataset dataset = open_dataset("kitti", folder, settings);
  LidarRun run;
  for (const NumberedFile& file : numbered_files(folder, {".bin", ".pcd"})) run.numbers.push_back(file.number);
  const MessageSource messages = dataset.recording.messages;
  dataset.recording.messages = [&] {
    auto message = messages();
    if (message && std::holds_alternative<LidarScan>(message->payload)) run.ends_ns.push_back(message->delivery_ns);
    return message;
  };
  EstimatorConfig config;
  config.imu_enabled = false;
  const auto estimator = make_estimator("loam", dataset.calibration, config);
  run.estimate = run_recording(dataset.recording, {}, *estimator).estimate;
  if (run.estimate.empty() || run.ends_ns.size() != run.numbers.size()) {
    throw InputError(folder.string() + ": the estimator gave nothing");
  }
  return run;
}

std::vector<Step> read_steps(const fs::path& path) {
  std::vector<Step> steps;
  TextTable table(path);
  while (table.next()) {
    steps.push_back({std::llround(table.number(0)),
                     {rotation_from_rpy({0.0, 0.0, table.number(4) * kDegree}),
                      {table.number(1), table.number(2), table.number(3)}}});
  }
  return steps;
}

/// The last twelve numbers of the only line.
Pose read_camera_from_lidar(const fs::path& path) {
  TextTable table(path);
  if (!table.next() || table.size() < 12) throw InputError(path.string() + ": expected twelve numbers");
  std::vector<double> rows;
  for (std::size_t i = table.size() - 12; i < table.size(); ++i) rows.push_back(table.number(i));
  return kitti_pose(rows, path.string());
}

std::vector<Pose> read_camera_poses(const fs::path& path) {
  std::vector<Pose> poses;
  TextTable table(path);
  while (table.next()) {
    std::vector<double> rows;
    for (std::size_t i = 0; i < table.size(); ++i) rows.push_back(table.number(i));
    poses.push_back(kitti_pose(rows, path.string()));
  }
  return poses;
}

std::optional<fs::path> camera_poses_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with("gt_cam_poses")) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found.empty() ? std::nullopt : std::optional(found.front());
}

bool has_scans(const fs::path& folder) { return numbered_files(folder, {".bin", ".pcd"}).size() > 1; }

std::string step_name(std::int64_t scan) { return "step to scan " + std::to_string(scan); }

}  // namespace

bool has_raw_steps(const fs::path& folder) { return fs::exists(folder / kStepsFile) && has_scans(folder); }

CheckRows check_raw_steps(const fs::path& folder) {
  constexpr double kPosition_m = 0.03;
  constexpr double kYaw_deg = 0.1;
  const LidarRun run = run_lidar(folder, PointTimes::kAzimuth);
  CheckRows rows;
  for (const Step& step : read_steps(folder / kStepsFile)) {
    const auto scan = std::find(run.numbers.begin(), run.numbers.end(), step.scan);
    if (scan == run.numbers.end() || scan == run.numbers.begin()) continue;
    const Pose error = step.before_from_scan.inverse() * run.step(static_cast<std::size_t>(scan - run.numbers.begin()));
    const double yaw_deg = rpy_from_rotation(error.rotation).z() / kDegree;
    const Eigen::Vector3d& t = error.translation;
    rows.push_back({folder.filename().string(), step_name(step.scan), "x, y ≤ 3 cm, yaw ≤ 0.1°",
                    fixed_text(100.0 * t.x(), 1) + ", " + fixed_text(100.0 * t.y(), 1) + " cm (z " +
                        fixed_text(100.0 * t.z(), 1) + "), " + fixed_text(yaw_deg, 3) + "°",
                    std::abs(t.x()) <= kPosition_m && std::abs(t.y()) <= kPosition_m && std::abs(yaw_deg) <= kYaw_deg});
  }
  return rows;
}

bool has_odometry_pairs(const fs::path& folder) {
  return fs::exists(folder / "calib_Tr.txt") && camera_poses_in(folder) && has_scans(folder);
}

CheckRows check_odometry_pairs(const fs::path& folder) {
  constexpr double kPosition_m = 0.02;
  constexpr double kRotation_deg = 0.05;
  const LidarRun run = run_lidar(folder, PointTimes::kNone);
  const std::vector<Pose> cameras = read_camera_poses(*camera_poses_in(folder));
  if (cameras.size() != run.numbers.size()) {
    throw InputError(camera_poses_in(folder)->string() + ": found " + std::to_string(cameras.size()) +
                     " poses, expected one for each of " + std::to_string(run.numbers.size()) + " scans");
  }
  const Pose camera_from_lidar = read_camera_from_lidar(folder / "calib_Tr.txt");
  CheckRows rows;
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    // Files of some scans only hold those whose neighbour is there, too.
    if (run.numbers[i] != run.numbers[i - 1] + 1) continue;
    const Pose truth = camera_from_lidar.inverse() * cameras[i - 1].inverse() * cameras[i] * camera_from_lidar;
    const Pose error = truth.inverse() * run.step(i);
    const double rotation_deg = 2.0 * std::asin(std::min(1.0, error.rotation.vec().norm())) / kDegree;
    rows.push_back({folder.filename().string(), step_name(run.numbers[i]), "≤ 2 cm, ≤ 0.05°",
                    fixed_text(100.0 * error.translation.norm(), 1) + " cm, " + fixed_text(rotation_deg, 3) + "°",
                    error.translation.norm() <= kPosition_m && rotation_deg <= kRotation_deg});
  }
  return rows;
}

}  // namespace plumbline
