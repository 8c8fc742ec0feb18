#pragma once

#include <cmath>
#include <cstdint>
#include "tools/formats/dataset.h"

/// The ASL format of EuRoC MAV: mav0/ with cam0/ and cam1/ (data.csv and data/*.png, or images that lie loose, named by
/// their nanoseconds), imu0/data.csv, state_groundtruth_estimate0/data.csv, and a sensor.yaml in each. It holds no
/// lidar and no depth images; cameras are 0 and 1.
namespace plumbline {

/// @param path  the folder of mav0, or mav0 itself
Dataset open_euroc(const std::filesystem::path& path, const DatasetSettings& settings);

std::unique_ptr<DatasetWriter> make_euroc_writer(const std::filesystem::path& directory,
                                                 const Calibration& calibration);

/// EuRoC stamps the moment of a reading. Taken for the mean over an interval, as ImuSample is, that interval ends half
/// a period later: left out, this turns an estimate by 11 degrees within 20 s of fast motion.
inline std::int64_t euroc_half_period_ns(double imu_rate_hz) { return std::llround(0.5e9 / imu_rate_hz); }

}  // namespace plumbline
