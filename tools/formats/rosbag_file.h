#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "tools/formats/ros_messages.h"

/// ROS 1 bags, through rosbag_storage. The implementation is the one place that sees ROS's headers, and C++17.
namespace plumbline {

/// Opens a bag and reads the messages of some topics that are of a known type.
/// @throws std::runtime_error, also when a message is asked for, if the file is none or damaged
RosSource open_rosbag_file(const std::filesystem::path& path, const std::set<std::string>& topics);

/// @throws std::runtime_error if it cannot be written
std::unique_ptr<RosSink> make_rosbag_file(const std::filesystem::path& path);

}  // namespace plumbline
