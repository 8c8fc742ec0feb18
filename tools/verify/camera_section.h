#pragma once

#include "tools/verify/section.h"

namespace plumbline {

/// Photon transfer of every camera of the catalogue, and motion blur.
VerifySection camera_section();

}  // namespace plumbline
