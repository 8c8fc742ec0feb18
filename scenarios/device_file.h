#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/config_reader.h"

/// Reading one device's file of sensors/catalogue.
namespace plumbline {

/// Reads the file of a device, which must be of a kind. @throws InputError
void read_device(const std::string& name, const std::string& kind, const std::function<void(ConfigReader&)>& read_keys);

/// The conversion from a file's unit, which stands in the key, to SI.
void read_scaled(ConfigReader& reader, const std::string& key, double unit, double& value, Range range);
void read_scaled(ConfigReader& reader, const std::string& key, double unit, std::vector<double>& values, Range range);

}  // namespace plumbline
