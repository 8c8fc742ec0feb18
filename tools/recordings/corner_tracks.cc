#include "tools/recordings/corner_tracks.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "estimator/pipeline/vloam.h"
#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"
#include "scenarios/yaml_reader.h"
#include "tools/evaluation/figures.h"
#include "tools/formats/euroc.h"
#include "tools/formats/kitti_calibration.h"
#include "tools/formats/number_text.h"
#include "tools/formats/recorded_files.h"
#include "tools/formats/text_table.h"
#include "tools/recordings/board_pose.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSeparators = ", \t\r";
constexpr Range kAnything{-1e9, 1e9};
constexpr double kLargestDrift_percent = 1.0;
constexpr double kCameraRate_hz = 20.0;

// EuRoC's body_from_cam0 (cam0/sensor.yaml of its recordings), which config.yaml may override as T_body_cam0.
const std::vector<double> kEurocBodyFromCamera{0.0148655429818,  -0.999880929698,  0.00414029679422, -0.0216401454975,
                                               0.999557249008,   0.0149672133247,  0.025715529948,   -0.064676986768,
                                               -0.0257744366974, 0.00375618835797, 0.999660727178,   0.00981073058949};

std::vector<double> read_matrix(ConfigReader& reader, const std::string& key) {
  std::vector<double> data;
  if (const ConfigNode* node = reader.find(key)) {
    ConfigReader matrix(*node, key);
    matrix.read("data", data, kAnything);
    if (data.size() != 16) fail_at(*node, key + ".data", "16 numbers");
    data.resize(12);
  }
  return data;
}

CameraIntrinsics read_intrinsics(const ConfigNode& node, const std::string& key) {
  ConfigReader camera(node, key);
  std::vector<double> size, projection, lens;
  camera.read("resolution", size, {1.0, 8192.0});
  camera.read("proj_params", projection, kAnything);
  camera.read("dist_params", lens, kAnything);
  if (size.size() != 2 || projection.size() != 4 || lens.size() != 4) {
    fail_at(node, key, "resolution, proj_params and dist_params of two, four and four numbers");
  }
  return {static_cast<int>(size[0]),
          static_cast<int>(size[1]),
          projection[0],
          projection[1],
          projection[2],
          projection[3],
          {lens[0], lens[1], lens[2], lens[3]}};
}

Calibration read_calibration(const fs::path& path) {
  const ConfigNode file = read_yaml_file(path);
  ConfigReader reader(file, "");
  Calibration calibration;
  calibration.has_lidar = false;
  if (const ConfigNode* node = reader.find("imu0")) {
    ConfigReader imu(*node, "imu0");
    imu.read("rate", calibration.imu_rate_hz, {1.0, 1e4});
    imu.read("sigma_g_c", calibration.imu.gyro_density, {1e-9, 1.0});
    imu.read("sigma_a_c", calibration.imu.accel_density, {1e-9, 10.0});
    imu.read("sigma_gw_c", calibration.imu.gyro_random_walk, {1e-9, 1.0});
    imu.read("sigma_aw_c", calibration.imu.accel_random_walk, {1e-9, 10.0});
  }
  const ConfigNode* left = reader.find("cam0");
  const ConfigNode* right = reader.find("cam1");
  if (left == nullptr || right == nullptr) throw InputError(path.string() + ": no cam0 and cam1");
  const std::vector<double> mounting = read_matrix(reader, "T_body_cam0");
  calibration.camera = read_intrinsics(*left, "cam0");
  calibration.camera_rate_hz = kCameraRate_hz;
  calibration.body_from_camera = kitti_pose(mounting.empty() ? kEurocBodyFromCamera : mounting, path.string());
  const Pose left_from_right = kitti_pose(read_matrix(reader, "T_cam0_cam1"), path.string() + ": T_cam0_cam1");
  calibration.further_cameras.push_back(
      {1, calibration.body_from_camera * left_from_right, read_intrinsics(*right, "cam1"), kCameraRate_hz});
  return calibration;
}

/// What one camera saw at one time.
struct CornerFrame {
  PointFrame points;
  std::vector<BoardCorner> corners;
};

CornerFrame read_corners(const NumberedFile& file, int camera) {
  CornerFrame frame{{file.number, camera, {}}, {}};
  TextTable table(file.path, kSeparators);
  while (table.next()) {
    const Eigen::Vector2d pixel(table.number(5), table.number(6));
    frame.points.points.push_back({4 * table.whole(10) + table.whole(11), pixel.cast<float>()});
    frame.corners.push_back({{table.number(7), table.number(8), table.number(9)}, pixel});
  }
  return frame;
}

std::vector<ImuSample> read_samples(const fs::path& path, double rate_hz) {
  const std::int64_t half_period_ns = euroc_half_period_ns(rate_hz);
  std::vector<ImuSample> samples;
  TextTable table(path, kSeparators);
  while (table.next()) {
    samples.push_back({table.whole(0) + half_period_ns,
                       {table.number(1), table.number(2), table.number(3)},
                       {table.number(4), table.number(5), table.number(6)}});
  }
  return samples;
}

/// Hands everything over in the order of its stamps, samples first.
StampedPoses drive(Vloam& estimator, const std::vector<ImuSample>& samples, const std::vector<PointFrame>& frames) {
  StampedPoses estimate;
  auto frame = frames.begin();
  for (const ImuSample& sample : samples) {
    for (; frame != frames.end() && frame->stamp_ns < sample.stamp_ns; ++frame) estimator.add(*frame);
    estimator.add(sample);
    for (const Odometry& output : estimator.take()) estimate.push_back({output.stamp_ns, output.world_from_body});
  }
  return estimate;
}

}  // namespace

bool has_corner_tracks(const fs::path& folder) {
  return fs::exists(folder / "config.yaml") && fs::exists(folder / "imu0.csv") &&
         !numbered_files(folder / "cam0", {".csv"}).empty();
}

CheckRows check_corner_tracks(const fs::path& folder) {
  const Calibration calibration = read_calibration(folder / "config.yaml");
  std::vector<PointFrame> frames;
  StampedPoses truth;
  for (const int camera : {0, 1}) {
    for (const NumberedFile& file : numbered_files(folder / ("cam" + std::to_string(camera)), {".csv"})) {
      CornerFrame frame = read_corners(file, camera);
      frames.push_back(std::move(frame.points));
      if (camera != 0) continue;
      const auto camera_from_board = pose_of_board(frame.corners, calibration.camera);
      if (!camera_from_board) continue;
      truth.push_back({file.number, camera_from_board->inverse() * calibration.body_from_camera.inverse()});
    }
  }
  std::stable_sort(frames.begin(), frames.end(), [](const PointFrame& a, const PointFrame& b) {
    return a.stamp_ns != b.stamp_ns ? a.stamp_ns < b.stamp_ns : a.camera_id < b.camera_id;
  });

  EstimatorConfig config;
  config.lidar_enabled = false;
  Vloam estimator(calibration, config);
  const StampedPoses estimate = drive(estimator, read_samples(folder / "imu0.csv", calibration.imu_rate_hz), frames);
  const TrajectoryFigures figures = trajectory_figures(truth, estimate);
  const std::string worst = shown(figures.max_error_m);
  return {{folder.filename().string(), "visual-inertial on corner tracks, stereo depth", "drift ≤ 1 %",
           shown(figures.drift_percent) + " % of " + readable_text(figures.distance_m) + " m, worst " + worst + " m",
           figures.drift_percent && *figures.drift_percent <= kLargestDrift_percent}};
}

}  // namespace plumbline
