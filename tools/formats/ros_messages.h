#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/messages.h"

/// Bags' messages as both generations of ROS define them, free of either's types. C++17, as ROS 1's headers need it.
namespace plumbline {

/// A column of a cloud. Types: 1 int8, 2 uint8, 3 int16, 4 uint16, 5 int32, 6 uint32, 7 float32, 8 float64.
struct RosField {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 1;
};

/// sensor_msgs/PointCloud2
struct RosPointCloud {
  std::int64_t stamp_ns = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<RosField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::vector<std::uint8_t> data;
};

/// sensor_msgs/Image
struct RosImage {
  std::int64_t stamp_ns = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;
  bool is_bigendian = false;
  std::uint32_t step = 0;
  std::vector<std::uint8_t> data;
};

/// The last stands for geometry_msgs/PoseStamped, TransformStamped and nav_msgs/Odometry.
using RosPayload = std::variant<ImuSample, RosImage, RosPointCloud, PoseTrack::Stamped>;

struct RosMessage {
  std::string topic;
  std::int64_t time_ns = 0;  ///< at which it was recorded
  RosPayload payload;
};

/// The messages of some topics in the order of their recording; empty after the last.
using RosSource = std::function<std::optional<RosMessage>()>;

/// Where messages are recorded.
class RosSink {
 public:
  virtual ~RosSink() = default;
  virtual void write(const RosMessage& message) = 0;
  virtual void close() = 0;
};

/// No message may take more.
inline constexpr std::size_t kMostRosBytes = std::size_t{256} << 20;

}  // namespace plumbline
