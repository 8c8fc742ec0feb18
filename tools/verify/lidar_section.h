#pragma once

#include "tools/verify/section.h"

namespace plumbline {

/// Firings, noise, drop-out, edges, de-skewing and spread on flat patches of the lidars of the catalogue.
VerifySection lidar_section();

}  // namespace plumbline
