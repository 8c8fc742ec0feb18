#include "tools/formats/rosbag_file.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>

#include <algorithm>
#include <stdexcept>

namespace plumbline {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::int64_t stamp_of(const ros::Time& time) { return std::int64_t{time.sec} * kNanoseconds + time.nsec; }

/// ROS 1 knows no time before 1970, and none at its very start.
ros::Time time_of(std::int64_t stamp_ns) {
  const std::int64_t from_start_ns = std::max<std::int64_t>(stamp_ns, 0);
  return {static_cast<std::uint32_t>(from_start_ns / kNanoseconds),
          static_cast<std::uint32_t>(from_start_ns % kNanoseconds)};
}

template <typename Vector>
Eigen::Vector3d vector_of(const Vector& v) {
  return {v.x, v.y, v.z};
}

Eigen::Quaterniond rotation_of(const geometry_msgs::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

RosPayload payload_of(const sensor_msgs::Imu& imu) {
  return ImuSample{stamp_of(imu.header.stamp), vector_of(imu.angular_velocity), vector_of(imu.linear_acceleration)};
}

RosPayload payload_of(const sensor_msgs::Image& image) {
  return RosImage{stamp_of(image.header.stamp), image.height, image.width, image.encoding,
                  image.is_bigendian != 0,      image.step,   image.data};
}

RosPayload payload_of(const sensor_msgs::PointCloud2& cloud) {
  std::vector<RosField> fields;
  for (const auto& field : cloud.fields) fields.push_back({field.name, field.offset, field.datatype, field.count});
  return RosPointCloud{stamp_of(cloud.header.stamp), cloud.height,     cloud.width,    fields,
                       cloud.is_bigendian != 0,      cloud.point_step, cloud.row_step, cloud.data};
}

RosPayload payload_of(const geometry_msgs::PoseStamped& pose) {
  return PoseTrack::Stamped{stamp_of(pose.header.stamp),
                            {rotation_of(pose.pose.orientation), vector_of(pose.pose.position)}};
}

RosPayload payload_of(const nav_msgs::Odometry& odometry) {
  const auto& pose = odometry.pose.pose;
  return PoseTrack::Stamped{stamp_of(odometry.header.stamp), {rotation_of(pose.orientation), vector_of(pose.position)}};
}

RosPayload payload_of(const geometry_msgs::TransformStamped& transform) {
  return PoseTrack::Stamped{stamp_of(transform.header.stamp),
                            {rotation_of(transform.transform.rotation), vector_of(transform.transform.translation)}};
}

template <typename Message>
std::optional<RosPayload> payload_as(const rosbag::MessageInstance& instance) {
  const auto message = instance.isType<Message>() ? instance.instantiate<Message>() : nullptr;
  return message ? std::optional<RosPayload>(payload_of(*message)) : std::nullopt;
}

template <typename First, typename... Others>
std::optional<RosPayload> payload_as_any(const rosbag::MessageInstance& instance) {
  if (auto payload = payload_as<First>(instance)) return payload;
  if constexpr (sizeof...(Others) > 0) return payload_as_any<Others...>(instance);
  return std::nullopt;
}

/// What rosbag throws says little of which file it is about.
template <typename Call>
auto about(const std::string& path, Call call) {
  try {
    return call();
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": no ROS 1 bag, or a damaged one: " + error.what());
  }
}

class BagReader {
 public:
  BagReader(const std::string& path, const std::set<std::string>& topics)
      : path_(path), view_(about(path, [&] {
          bag_.open(path, rosbag::bagmode::Read);
          return std::make_unique<rosbag::View>(
              bag_, rosbag::TopicQuery(std::vector<std::string>(topics.begin(), topics.end())));
        })) {
    next_ = about(path, [&] { return view_->begin(); });
  }

  std::optional<RosMessage> next() {
    return about(path_, [&]() -> std::optional<RosMessage> {
      for (; next_ != view_->end(); ++next_) {
        const rosbag::MessageInstance& instance = *next_;
        if (instance.size() > kMostRosBytes) throw std::runtime_error("a message of more than 256 MB");
        auto payload =
            payload_as_any<sensor_msgs::Imu, sensor_msgs::Image, sensor_msgs::PointCloud2, geometry_msgs::PoseStamped,
                           nav_msgs::Odometry, geometry_msgs::TransformStamped>(instance);
        if (!payload) continue;
        RosMessage message{instance.getTopic(), stamp_of(instance.getTime()), std::move(*payload)};
        ++next_;
        return message;
      }
      return std::nullopt;
    });
  }

 private:
  std::string path_;
  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator next_;
};

class BagWriter final : public RosSink {
 public:
  explicit BagWriter(const std::filesystem::path& path) : path_(path.string()) {
    guarded([&] { bag_.open(path_, rosbag::bagmode::Write); });
  }

  void write(const RosMessage& message) override {
    guarded([&] {
      std::visit([&](const auto& payload) { record(message.topic, message.time_ns, payload); }, message.payload);
    });
  }

  void close() override {
    guarded([&] { bag_.close(); });
  }

 private:
  template <typename Call>
  void guarded(Call call) {
    try {
      call();
    } catch (const std::exception& error) {
      throw std::runtime_error(path_ + ": cannot be written: " + error.what());
    }
  }

  template <typename Message>
  void record(const std::string& topic, std::int64_t time_ns, const Message& message) {
    bag_.write(topic, std::max(time_of(time_ns), ros::TIME_MIN), ros_message(message));
  }

  static sensor_msgs::Imu ros_message(const ImuSample& sample) {
    sensor_msgs::Imu imu;
    imu.header.stamp = time_of(sample.stamp_ns);
    imu.header.frame_id = "imu";
    imu.orientation_covariance[0] = -1.0;  // no orientation
    set(imu.angular_velocity, sample.angular_rate);
    set(imu.linear_acceleration, sample.specific_force);
    return imu;
  }

  static sensor_msgs::Image ros_message(const RosImage& from) {
    sensor_msgs::Image image;
    image.header.stamp = time_of(from.stamp_ns);
    image.header.frame_id = "camera";
    image.height = from.height;
    image.width = from.width;
    image.encoding = from.encoding;
    image.is_bigendian = static_cast<std::uint8_t>(from.is_bigendian);
    image.step = from.step;
    image.data = from.data;
    return image;
  }

  static sensor_msgs::PointCloud2 ros_message(const RosPointCloud& from) {
    sensor_msgs::PointCloud2 cloud;
    cloud.header.stamp = time_of(from.stamp_ns);
    cloud.header.frame_id = "lidar";
    cloud.height = from.height;
    cloud.width = from.width;
    for (const RosField& field : from.fields) {
      sensor_msgs::PointField& column = cloud.fields.emplace_back();
      column.name = field.name;
      column.offset = field.offset;
      column.datatype = field.datatype;
      column.count = field.count;
    }
    cloud.is_bigendian = static_cast<std::uint8_t>(from.is_bigendian);
    cloud.point_step = from.point_step;
    cloud.row_step = from.row_step;
    cloud.data = from.data;
    cloud.is_dense = 1;
    return cloud;
  }

  static geometry_msgs::PoseStamped ros_message(const PoseTrack::Stamped& from) {
    geometry_msgs::PoseStamped pose;
    pose.header.stamp = time_of(from.stamp_ns);
    pose.header.frame_id = "world";
    set(pose.pose.position, from.pose.translation);
    set(pose.pose.orientation, from.pose.rotation);
    pose.pose.orientation.w = from.pose.rotation.w();
    return pose;
  }

  template <typename Target, typename Source>
  static void set(Target& target, const Source& source) {
    target.x = source.x();
    target.y = source.y();
    target.z = source.z();
  }

  std::string path_;
  rosbag::Bag bag_;
};

}  // namespace

RosSource open_rosbag_file(const std::filesystem::path& path, const std::set<std::string>& topics) {
  return [reader = std::make_shared<BagReader>(path.string(), topics)] { return reader->next(); };
}

std::unique_ptr<RosSink> make_rosbag_file(const std::filesystem::path& path) {
  return std::make_unique<BagWriter>(path);
}

}  // namespace plumbline
