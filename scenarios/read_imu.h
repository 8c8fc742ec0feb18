#pragma once

#include "scenarios/config_reader.h"
#include "scenarios/scenario.h"

namespace plumbline {

/// The figures of a unit: the keys of a file of sensors/catalogue, which rig.imu may set, too.
void read_imu_figures(ConfigReader& reader, ImuModel& model);

/// The section rig.imu.
void read_imu(ConfigReader& reader, RigConfig& config);

}  // namespace plumbline
