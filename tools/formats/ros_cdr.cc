#include "tools/formats/ros_cdr.h"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <array>
#include <memory>
#include <stdexcept>

namespace plumbline {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

constexpr std::int64_t kNanoseconds = 1'000'000'000;
constexpr std::size_t kMostFields = 256;

// Reading.

std::int64_t read_header(Cdr& cdr) {
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  std::string frame;
  cdr >> seconds >> nanoseconds >> frame;
  return std::int64_t{seconds} * kNanoseconds + nanoseconds;
}

/// A sequence's length, checked before memory is taken for it.
std::uint32_t read_length(Cdr& cdr, std::size_t most) {
  std::uint32_t length = 0;
  cdr >> length;
  if (length > most) throw std::invalid_argument("a sequence of " + std::to_string(length) + " items");
  return length;
}

std::vector<std::uint8_t> read_bytes(Cdr& cdr, std::size_t size) {
  const std::uint32_t length = read_length(cdr, size);
  std::vector<std::uint8_t> bytes(length);
  if (length > 0) cdr.deserializeArray(bytes.data(), length);
  return bytes;
}

Eigen::Vector3d read_vector(Cdr& cdr) {
  Eigen::Vector3d v;
  cdr >> v.x() >> v.y() >> v.z();
  return v;
}

Pose read_pose(Cdr& cdr) {
  Pose pose;
  pose.translation = read_vector(cdr);
  cdr >> pose.rotation.x() >> pose.rotation.y() >> pose.rotation.z() >> pose.rotation.w();
  return pose;
}

RosPayload read_imu(Cdr& cdr) {
  ImuSample sample;
  sample.stamp_ns = read_header(cdr);
  std::array<double, 4> orientation{};
  std::array<double, 9> covariance{};
  cdr >> orientation >> covariance;
  sample.angular_rate = read_vector(cdr);
  cdr >> covariance;
  sample.specific_force = read_vector(cdr);
  cdr >> covariance;
  return sample;
}

RosPayload read_image(Cdr& cdr, std::size_t size) {
  RosImage image;
  image.stamp_ns = read_header(cdr);
  std::uint8_t is_bigendian = 0;
  cdr >> image.height >> image.width >> image.encoding >> is_bigendian >> image.step;
  image.is_bigendian = is_bigendian != 0;
  image.data = read_bytes(cdr, size);
  return image;
}

RosPayload read_cloud(Cdr& cdr, std::size_t size) {
  RosPointCloud cloud;
  cloud.stamp_ns = read_header(cdr);
  cdr >> cloud.height >> cloud.width;
  cloud.fields.resize(read_length(cdr, kMostFields));
  for (RosField& field : cloud.fields) cdr >> field.name >> field.offset >> field.datatype >> field.count;
  cdr >> cloud.is_bigendian >> cloud.point_step >> cloud.row_step;
  cloud.data = read_bytes(cdr, size);
  return cloud;
}

RosPayload read_stamped_pose(Cdr& cdr, bool has_child_frame) {
  PoseTrack::Stamped stamped;
  stamped.stamp_ns = read_header(cdr);
  std::string child_frame;
  if (has_child_frame) cdr >> child_frame;
  stamped.pose = read_pose(cdr);
  return stamped;
}

// Writing.

void write_header(Cdr& cdr, std::int64_t stamp_ns, const std::string& frame) {
  // Floored, so that the nanoseconds are never negative.
  std::int64_t seconds = stamp_ns / kNanoseconds;
  if (stamp_ns % kNanoseconds < 0) --seconds;
  cdr << static_cast<std::int32_t>(seconds) << static_cast<std::uint32_t>(stamp_ns - seconds * kNanoseconds) << frame;
}

void write_bytes(Cdr& cdr, const std::vector<std::uint8_t>& bytes) {
  cdr << static_cast<std::uint32_t>(bytes.size());
  if (!bytes.empty()) cdr.serializeArray(bytes.data(), bytes.size());
}

void write_vector(Cdr& cdr, const Eigen::Vector3d& v) { cdr << v.x() << v.y() << v.z(); }

void write(Cdr& cdr, const ImuSample& sample) {
  write_header(cdr, sample.stamp_ns, "imu");
  constexpr std::array<double, 9> kUnknown{};
  cdr << std::array<double, 4>{0.0, 0.0, 0.0, 1.0} << std::array<double, 9>{-1.0};  // no orientation
  write_vector(cdr, sample.angular_rate);
  cdr << kUnknown;
  write_vector(cdr, sample.specific_force);
  cdr << kUnknown;
}

void write(Cdr& cdr, const RosImage& image) {
  write_header(cdr, image.stamp_ns, "camera");
  cdr << image.height << image.width << image.encoding << static_cast<std::uint8_t>(image.is_bigendian) << image.step;
  write_bytes(cdr, image.data);
}

void write(Cdr& cdr, const RosPointCloud& cloud) {
  write_header(cdr, cloud.stamp_ns, "lidar");
  cdr << cloud.height << cloud.width << static_cast<std::uint32_t>(cloud.fields.size());
  for (const RosField& field : cloud.fields) cdr << field.name << field.offset << field.datatype << field.count;
  cdr << cloud.is_bigendian << cloud.point_step << cloud.row_step;
  write_bytes(cdr, cloud.data);
  cdr << true;  // is_dense
}

void write(Cdr& cdr, const PoseTrack::Stamped& stamped) {
  write_header(cdr, stamped.stamp_ns, "world");
  write_vector(cdr, stamped.pose.translation);
  const Eigen::Quaterniond& q = stamped.pose.rotation;
  cdr << q.x() << q.y() << q.z() << q.w();
}

}  // namespace

std::string ros2_type(const RosPayload& payload) {
  static const char* const kTypes[] = {"sensor_msgs/msg/Imu", "sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2",
                                       "geometry_msgs/msg/PoseStamped"};
  return kTypes[payload.index()];
}

std::string to_cdr(const RosPayload& payload) {
  FastBuffer buffer;
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  std::visit([&](const auto& message) { write(cdr, message); }, payload);
  return {buffer.getBuffer(), cdr.getSerializedDataLength()};
}

std::optional<RosPayload> from_cdr(const std::string& type, std::string_view bytes) {
  // The reader takes a pointer that is not const, and only reads.
  FastBuffer buffer(const_cast<char*>(bytes.data()), bytes.size());
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  try {
    cdr.read_encapsulation();
    if (type == "sensor_msgs/msg/Imu") return read_imu(cdr);
    if (type == "sensor_msgs/msg/Image") return read_image(cdr, bytes.size());
    if (type == "sensor_msgs/msg/PointCloud2") return read_cloud(cdr, bytes.size());
    if (type == "geometry_msgs/msg/PoseStamped") return read_stamped_pose(cdr, false);
    if (type == "geometry_msgs/msg/TransformStamped" || type == "nav_msgs/msg/Odometry") {
      return read_stamped_pose(cdr, true);
    }
  } catch (const eprosima::fastcdr::exception::Exception& error) {
    throw std::invalid_argument(std::string("no ") + type + ": " + error.what());
  }
  return std::nullopt;
}

}  // namespace plumbline
