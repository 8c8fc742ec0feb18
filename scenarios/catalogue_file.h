#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/config_reader.h"
#include "sim/constants.h"

/// Reading one file of sensors/catalogue.
namespace plumbline {

/// Units of catalogue files, in SI.
inline constexpr double kMicro = 1e-6;
inline constexpr double kMilli = 1e-3;
inline constexpr double kPercent = 1e-2;
inline constexpr double kDegreePerHour = kDegree / 3600.0;
inline constexpr double kStandardG = 9.80665;  ///< [m/s^2]

/// Opens a device's file and has its keys read to the full, `kind` and `summary` aside.
/// @throws InputError if there is none, or if it is of another kind
void read_device(const std::string& name, const std::string& kind, const std::function<void(ConfigReader&)>& read_keys);

/// The conversion from a file's unit, which stands in the key, to SI.
void read_scaled(ConfigReader& reader, const std::string& key, double unit, double& value, Range range);
void read_scaled(ConfigReader& reader, const std::string& key, double unit, std::vector<double>& values, Range range);

}  // namespace plumbline
