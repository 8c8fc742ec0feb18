#include "scenarios/catalogue.h"
#include "scenarios/catalogue_file.h"
#include "scenarios/read_imu.h"

namespace plumbline {
namespace {

void read_triad(ConfigReader& reader, const std::string& name, TriadErrors& errors) {
  read_scaled(reader, name + "_scale_percent", kPercent, errors.scale_sigma, {0.0, 10.0});
  read_scaled(reader, name + "_misalignment_deg", kDegree, errors.misalignment_sigma_rad, {0.0, 10.0});
}

}  // namespace

void read_imu_figures(ConfigReader& reader, ImuModel& model) {
  ImuNoise& noise = model.noise;
  read_scaled(reader, "gyro_density_deg_per_s_sqrt_hz", kDegree, noise.gyro_density, {0.0, 10.0});
  read_scaled(reader, "accel_density_ug_per_sqrt_hz", kMicro * kStandardG, noise.accel_density, {0.0, 1e5});
  read_scaled(reader, "gyro_bias_instability_deg_per_h", kDegreePerHour, noise.gyro_bias_instability, {0.0, 1e4});
  read_scaled(reader, "accel_bias_instability_ug", kMicro * kStandardG, noise.accel_bias_instability, {0.0, 1e5});
  reader.read("gyro_random_walk", noise.gyro_random_walk, {0.0, 1.0});
  reader.read("accel_random_walk", noise.accel_random_walk, {0.0, 10.0});
  read_scaled(reader, "gyro_turn_on_deg_per_s", kDegree, noise.gyro_turn_on_sigma, {0.0, 100.0});
  reader.read("accel_turn_on_mps2", noise.accel_turn_on_sigma, {0.0, 10.0});

  read_triad(reader, "gyro", model.gyro);
  read_triad(reader, "accel", model.accel);
  read_scaled(reader, "gyro_g_sensitivity_deg_per_s_per_g", kDegree / kStandardG, model.g_sensitivity_sigma,
              {0.0, 10.0});
  read_scaled(reader, "gyro_range_deg_per_s", kDegree, model.gyro.range, {0.0, 1e5});
  read_scaled(reader, "accel_range_g", kStandardG, model.accel.range, {0.0, 1e3});
  read_scaled(reader, "gyro_resolution_deg_per_s", kDegree, model.gyro.resolution, {0.0, 10.0});
  read_scaled(reader, "accel_resolution_mg", kMilli * kStandardG, model.accel.resolution, {0.0, 100.0});
}

ImuModel catalogue_imu(const std::string& name) {
  ImuModel model;
  model.name = name;
  read_device(name, "imu", [&](ConfigReader& reader) {
    reader.read("rate_hz", model.rate_hz, {10.0, 2000.0});
    read_imu_figures(reader, model);
  });
  return model;
}

}  // namespace plumbline
