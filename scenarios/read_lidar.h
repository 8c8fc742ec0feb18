#pragma once

#include "scenarios/config_reader.h"
#include "scenarios/scenario.h"

namespace plumbline {

/// The keys of rig.lidar but for its mounting: which device, what it reports, what makes it err.
void read_lidar_device(ConfigReader& reader, RigConfig& config);

}  // namespace plumbline
