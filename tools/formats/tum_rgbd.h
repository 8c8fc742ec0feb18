#pragma once

#include "tools/formats/dataset.h"

/// The TUM RGB-D benchmark's folders: rgb.txt and depth.txt ("stamp_s file" a line), accelerometer.txt ("stamp_s ax ay
/// az"), groundtruth.txt (poses of the colour camera, "stamp_s x y z qx qy qz qw"). Depth is a 16-bit PNG of 1/5000 m,
/// 0 where there is none. It holds no gyroscope, so the samples are a clock only, and no lidar; the colour camera is
/// camera 0. Without a calibration of ours the camera is taken for a Kinect's.
namespace plumbline {

Dataset open_tum_rgbd(const std::filesystem::path& path, const DatasetSettings& settings);

std::unique_ptr<DatasetWriter> make_tum_rgbd_writer(const std::filesystem::path& directory,
                                                    const Calibration& calibration);

}  // namespace plumbline
