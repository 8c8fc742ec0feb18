#include "tools/recordings/imu_start.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/imu/initialization.h"
#include "scenarios/input_error.h"
#include "sim/constants.h"
#include "tools/evaluation/pairing.h"
#include "tools/evaluation/quantile.h"
#include "tools/formats/dataset.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kWindow_ns = 1'000'000'000;
constexpr std::int64_t kSlope_ns = 100'000'000;  // over which the truth's positions tell the velocity

// At rest, tilt and the accelerometer's bias are one unknown: 0.1 m/s^2 of it, a MEMS sensor's, tilt by 0.6 degrees.
constexpr double kTilt_deg = 1.0;
// A second at 0.3 m/s^2 of error that flight adds (scale, misalignment, vibration) and 3 cm/s of the truth's slopes.
constexpr double kMedian_m = 0.10;
constexpr double kMedian_deg = 0.2;

fs::path truth_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("gt") && name.ends_with(".txt")) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found.empty() ? fs::path() : found.front();
}

struct ImuRecording {
  Calibration calibration;
  std::vector<ImuSample> samples;
  StampedPoses truth;
};

ImuRecording read_recording(const fs::path& folder) {
  DatasetSettings settings;
  settings.truth = truth_in(folder);
  const Dataset dataset = open_dataset("euroc", folder, settings);
  ImuRecording recording{dataset.calibration, {}, dataset.recording.truth};
  while (const auto message = dataset.recording.messages()) {
    if (const auto* sample = std::get_if<ImuSample>(&message->payload)) recording.samples.push_back(*sample);
  }
  if (recording.samples.empty() || recording.truth.empty()) {
    throw InputError(folder.string() + ": holds no samples or no truth");
  }
  return recording;
}

std::optional<InitialState> start_of(const ImuRecording& recording) {
  Initializer initializer(recording.calibration);
  for (const ImuSample& sample : recording.samples) {
    if (auto start = initializer.add(sample)) return start;
  }
  return std::nullopt;
}

/// The angle between the two down directions.
double tilt_between_deg(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Vector3d down_a = a.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d down_b = b.conjugate() * Eigen::Vector3d::UnitZ();
  return std::atan2(down_a.cross(down_b).norm(), down_a.dot(down_b)) / kDegree;
}

/// The true state at a time with the biases of the start.
NavigationState true_state(const ImuRecording& recording, std::int64_t stamp_ns, const NavigationState& start) {
  NavigationState state = start;
  state.stamp_ns = stamp_ns;
  state.world_from_body = pose_at(recording.truth, stamp_ns);
  const Pose before = pose_at(recording.truth, stamp_ns - kSlope_ns / 2);
  const Pose after = pose_at(recording.truth, stamp_ns + kSlope_ns / 2);
  state.velocity_in_world = (after.translation - before.translation) / (1e-9 * kSlope_ns);
  return state;
}

/// The start with its accelerometer bias split from the tilt by the true attitude.
NavigationState with_true_tilt(const InitialState& start, const Pose& world_from_body) {
  NavigationState state = start.state;
  // The mean force at rest, as the start explains it.
  const Eigen::Vector3d force = state.accel_bias - state.world_from_body.rotation.conjugate() * state.gravity_in_world;
  state.accel_bias = force + world_from_body.rotation.conjugate() * state.gravity_in_world;
  return state;
}

struct PropagationErrors {
  std::vector<double> position_m;
  std::vector<double> rotation_deg;
};

PropagationErrors propagate(const ImuRecording& recording, const NavigationState& start) {
  PropagationErrors errors;
  const std::vector<ImuSample>& samples = recording.samples;
  const std::int64_t last_ns = recording.truth.back().stamp_ns - kSlope_ns;
  std::size_t next = 1;
  for (std::int64_t from_ns = std::max(start.stamp_ns, recording.truth.front().stamp_ns + kSlope_ns);
       from_ns + kWindow_ns < last_ns; from_ns += kWindow_ns) {
    while (next < samples.size() && samples[next].stamp_ns <= from_ns) ++next;
    NavigationState state = true_state(recording, from_ns, start);
    for (std::size_t i = next; i < samples.size() && state.stamp_ns < from_ns + kWindow_ns; ++i) {
      const std::int64_t to_ns = std::min(samples[i].stamp_ns, from_ns + kWindow_ns);
      state = mechanize(state, segment_between(samples[i - 1], samples[i]).part(state.stamp_ns, to_ns));
    }
    if (state.stamp_ns != from_ns + kWindow_ns) break;
    const Vector6d error = pose_at(recording.truth, state.stamp_ns).local(state.world_from_body);
    errors.position_m.push_back(error.tail<3>().norm());
    errors.rotation_deg.push_back(error.head<3>().norm() / kDegree);
  }
  return errors;
}

}  // namespace

bool has_imu_and_truth(const fs::path& folder) {
  return fs::exists(folder / "imu0" / "data.csv") &&
         (!truth_in(folder).empty() || fs::exists(folder / "state_groundtruth_estimate0" / "data.csv"));
}

CheckRows check_imu(const fs::path& folder) {
  const ImuRecording recording = read_recording(folder);
  const std::string name = folder.filename().string();
  const auto start = start_of(recording);
  if (!start) return {{name, "static initialisation", "at rest", "too few samples", false}};
  CheckRows rows;
  const Pose truth = pose_at(recording.truth, start->state.stamp_ns);
  const double tilt_deg = tilt_between_deg(start->state.world_from_body.rotation, truth.rotation);
  const Eigen::Vector3d gyro_bias_deg = start->state.gyro_bias / kDegree;
  rows.push_back({name, "static initialisation", "tilt ≤ 1°",
                  fixed_text(tilt_deg, 2) + "°, gyro bias " + fixed_text(gyro_bias_deg.x(), 2) + ", " +
                      fixed_text(gyro_bias_deg.y(), 2) + ", " + fixed_text(gyro_bias_deg.z(), 2) + " °/s",
                  tilt_deg <= kTilt_deg && start->velocity_sigma < 1.0});
  const PropagationErrors errors = propagate(recording, with_true_tilt(*start, truth));
  if (errors.position_m.empty()) return rows;
  const double median_m = *quantile(errors.position_m, 0.5);
  const double median_deg = *quantile(errors.rotation_deg, 0.5);
  rows.push_back(
      {name, "1 s of the IMU alone, " + std::to_string(errors.position_m.size()) + " times", "median ≤ 10 cm, 0.2°",
       fixed_text(100.0 * median_m, 1) + " cm (p95 " + fixed_text(100.0 * *quantile(errors.position_m, 0.95), 1) +
           "), " + fixed_text(median_deg, 3) + "° (p95 " + fixed_text(*quantile(errors.rotation_deg, 0.95), 3) + ")",
       median_m <= kMedian_m && median_deg <= kMedian_deg});
  return rows;
}

}  // namespace plumbline
