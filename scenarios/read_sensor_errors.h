#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/config_reader.h"
#include "scenarios/scenario.h"

/// Errors that any sensor may have, of which the estimator is not told.
namespace plumbline {

/// A sensor's keys clock.{offset_ms,drift_ppm,jitter_us}, delay_ms and delay_jitter_ms.
void read_timing(ConfigReader& reader, SensorTiming& timing);

/// A sensor's section miscalibration: {roll,pitch,yaw}_deg and {x,y,z}_m as given, and on top of them a draw per seed
/// of sigma_deg and sigma_m per axis.
/// @param sensor  name of the draw's stream
/// @return told_mount_from_mount: where the sensor is in truth, seen from where the estimator is told
Pose read_miscalibration(ConfigReader& reader, std::uint64_t seed, const std::string& sensor);

/// A scenario's list of faults.
void read_faults(const ConfigNode& node, const std::string& key, std::vector<Fault>& faults);

}  // namespace plumbline
