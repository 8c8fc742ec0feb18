#pragma once

#include <string>

#include "tools/mount/mount_predictor.h"

namespace plumbline {

/// What the lidar sees, near bright and far dark, the vehicle's own body in red, as a figure; and what the camera does,
/// lit from the camera's place.
std::string lidar_view_figure(const MountView::Picture& picture, const std::string& caption);
std::string camera_view_figure(const MountView::Picture& picture, const std::string& caption);

}  // namespace plumbline
