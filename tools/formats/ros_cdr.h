#pragma once

#include <string>
#include <string_view>

#include "tools/formats/ros_messages.h"

/// ROS 2's serialisation, CDR, of the messages that we know.
namespace plumbline {

/// sensor_msgs/msg/Imu and so on; a pose is written as geometry_msgs/msg/PoseStamped.
std::string ros2_type(const RosPayload& payload);

std::string to_cdr(const RosPayload& payload);

/// @param type  as ros2_type gives it, or geometry_msgs/msg/TransformStamped, nav_msgs/msg/Odometry
/// @return empty for a type that is not known
/// @throws std::invalid_argument for bytes that are no such message
std::optional<RosPayload> from_cdr(const std::string& type, std::string_view bytes);

}  // namespace plumbline
