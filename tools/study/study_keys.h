#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/config_reader.h"

namespace plumbline {

/// What a run may take before it is ended and recorded as such.
struct RunLimits {
  double time_s = 3600.0;
  double memory_mb = 8192.0;  ///< resident
};

/// Keys that files of studies share. Each leaves the default where the file says nothing. @throws InputError

/// seeds: [N, ...] or a count (1 ... N). @param seeds  ascending
void read_seeds(ConfigReader& reader, std::vector<std::uint64_t>& seeds);
/// limits: {time_s, memory_mb}
/// @param further  reads what else may stand there
void read_limits(ConfigReader& reader, RunLimits& limits, const std::function<void(ConfigReader&)>& further = {});
/// set: {KEY: VALUE}, appended as KEY=VALUE
void read_fixed(ConfigReader& reader, std::vector<std::string>& fixed);

}  // namespace plumbline
