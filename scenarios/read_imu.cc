#include "scenarios/read_imu.h"

#include <optional>

#include "scenarios/catalogue_file.h"
#include "scenarios/read_sensor_errors.h"
#include "scenarios/rig_reader.h"

namespace plumbline {
namespace {

constexpr Range kImuRate_hz{50.0, 1000.0};
constexpr Range kOffset_m{-10.0, 10.0};

void read_vector(ConfigReader& reader, const std::string& key, double unit, Range range,
                 std::optional<Eigen::Vector3d>& value) {
  std::vector<double> items;
  if (!reader.read(key, items, range)) return;
  if (items.size() != 3) fail_at(*reader.find(key), reader.path_of(key), "three numbers [x, y, z]");
  value = unit * Eigen::Vector3d(items[0], items[1], items[2]);
}

void read_vibration(ConfigReader& reader, VibrationModel& vibration) {
  reader.read("vibration_mps2", vibration.rms_mps2, {0.0, 100.0});
  reader.read("vibration_per_speed", vibration.rms_per_speed, {0.0, 100.0});
  reader.read("vibration_low_hz", vibration.low_hz, {0.1, 1e4});
  reader.read("vibration_high_hz", vibration.high_hz, {0.1, 1e4});
}

void read_effects(ConfigReader& reader, ImuEffects& effects) {
  reader.read("white_noise", effects.white_noise);
  reader.read("bias_instability", effects.bias_instability);
  reader.read("random_walk", effects.random_walk);
  reader.read("turn_on_bias", effects.turn_on_bias);
  reader.read("scale", effects.scale);
  reader.read("misalignment", effects.misalignment);
  reader.read("g_sensitivity", effects.g_sensitivity);
  reader.read("saturation", effects.saturation);
  reader.read("quantisation", effects.quantisation);
  reader.read("vibration", effects.vibration);
}

}  // namespace

void read_imu(ConfigReader& reader, RigConfig& config) {
  ImuModel& imu = config.imu;
  read_model(reader, "imu", catalogue_imu, imu);
  reader.read("rate_hz", imu.rate_hz, kImuRate_hz);
  read_imu_figures(reader, imu);
  reader.read("x_m", imu.position_in_body.x(), kOffset_m);
  reader.read("y_m", imu.position_in_body.y(), kOffset_m);
  reader.read("z_m", imu.position_in_body.z(), kOffset_m);
  read_timing(reader, config.imu_timing);
  read_vector(reader, "gyro_bias_deg_per_s", kDegree, {-100.0, 100.0}, imu.gyro_turn_on_bias);
  read_vector(reader, "accel_bias_mps2", 1.0, {-10.0, 10.0}, imu.accel_turn_on_bias);
  read_vibration(reader, imu.vibration);
  reader.section("effects", [&](ConfigReader& effects) { read_effects(effects, imu.effects); });
  reader.read("noise", config.imu_noise);
  check_model(reader, imu);
}

}  // namespace plumbline
