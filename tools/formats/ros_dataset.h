#pragma once

#include "tools/formats/dataset.h"

/// Bags of sensor_msgs Imu, Image and PointCloud2 and a topic of true poses (geometry_msgs PoseStamped or
/// TransformStamped, nav_msgs Odometry), on the topics that DatasetSettings names. Messages are delivered in the order
/// of their recording. A bag says nothing of its sensors' calibration: an export holds calibration.yaml beside it;
/// other bags need dataset.calibration.
namespace plumbline {

/// @param path  a .bag file, or a folder that holds one
Dataset open_rosbag(const std::filesystem::path& path, const DatasetSettings& settings);
/// @param path  a bag's folder or .db3 file
Dataset open_rosbag2(const std::filesystem::path& path, const DatasetSettings& settings);

std::unique_ptr<DatasetWriter> make_rosbag_writer(const std::filesystem::path& directory,
                                                  const Calibration& calibration);
std::unique_ptr<DatasetWriter> make_rosbag2_writer(const std::filesystem::path& directory,
                                                   const Calibration& calibration);

}  // namespace plumbline
