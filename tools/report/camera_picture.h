#pragma once

#include <string>

#include "scenarios/run_record.h"

namespace plumbline {

/// A camera frame with what the estimator tracked there, as a figure: each feature by where its depth came from,
/// outliers crossed, a line to where the key-frame saw it.
std::string camera_picture(const FrameSnapshot& snapshot, std::int64_t start_ns);

/// The legend that goes with the pictures.
std::string camera_legend();

}  // namespace plumbline
