#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "estimator/messages.h"

namespace plumbline {

/// Systematic errors of three like axes. Each sigma is of a constant drawn once per seed.
struct TriadErrors {
  double scale_sigma = 0.0;             ///< of each axis's gain, relative
  double misalignment_sigma_rad = 0.0;  ///< of each axis towards each other one: non-orthogonality and mounting in one
  double range = 0.0;                   ///< readings are clipped to +- this [rad/s or m/s^2]; 0: never
  double resolution = 0.0;              ///< step of the output [rad/s or m/s^2]; 0: continuous
};

/// Shaking of the structure that the unit is screwed to, which the body's path does not hold: band-limited
/// acceleration, the same in all directions.
struct VibrationModel {
  double rms_mps2 = 0.0;       ///< per axis, whatever the speed: engines, rotors
  double rms_per_speed = 0.0;  ///< grows with the body's speed: wheels on a road [1/s]
  double low_hz = 20.0;
  double high_hz = 80.0;
};

/// Which errors act. A figure that is switched off counts as zero.
struct ImuEffects {
  bool white_noise = true;
  bool bias_instability = true;
  bool random_walk = true;
  bool turn_on_bias = true;
  bool scale = true;
  bool misalignment = true;
  bool g_sensitivity = true;
  bool saturation = true;
  bool quantisation = true;
  bool vibration = true;
};

/// An inertial unit, its axes parallel to the body's.
struct ImuModel {
  std::string name = "bmi055";
  double rate_hz = 200.0;
  ImuNoise noise;  ///< random errors, as an estimator may be told them
  TriadErrors gyro;
  TriadErrors accel;
  double g_sensitivity_sigma = 0.0;  ///< of each gyro axis to each axis of specific force [rad/s per m/s^2]
  Eigen::Vector3d position_in_body = Eigen::Vector3d::Zero();  ///< [m]
  VibrationModel vibration;
  std::optional<Eigen::Vector3d> gyro_turn_on_bias;   ///< in place of a drawn one [rad/s]
  std::optional<Eigen::Vector3d> accel_turn_on_bias;  ///< in place of a drawn one [m/s^2]
  ImuEffects effects;
};

/// @throws std::invalid_argument naming the field that is out of range.
void validate_or_throw(const ImuModel& model);

}  // namespace plumbline
