#pragma once

#include "tools/verify/section.h"

namespace plumbline {

/// The random errors of every inertial unit of the catalogue against their figures.
VerifySection imu_section();

}  // namespace plumbline
