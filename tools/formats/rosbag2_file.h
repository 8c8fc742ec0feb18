#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "tools/formats/ros_messages.h"

/// ROS 2 bags of SQLite storage: a folder of metadata.yaml and databases of CDR messages, uncompressed.
namespace plumbline {

/// @param path  the folder, or one of its .db3 files
/// @throws InputError, also when a message is asked for
RosSource open_rosbag2_file(const std::filesystem::path& path, const std::set<std::string>& topics);

/// Writes data_0.db3 and metadata.yaml into a folder. @throws std::runtime_error
std::unique_ptr<RosSink> make_rosbag2_file(const std::filesystem::path& directory);

}  // namespace plumbline
