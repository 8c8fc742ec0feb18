#include "tools/formats/ros_conversion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <stdexcept>

#include "tools/formats/image_file.h"

namespace plumbline {
namespace {

static_assert(std::endian::native == std::endian::little, "fields are copied as they stand in memory");

constexpr std::size_t kMostCloudPoints = 8'000'000;
constexpr double kAbsoluteTime_s = 1e6;
constexpr std::int64_t kFurthest_ns = 2'000'000'000;
constexpr float kFurthestReturn_m = 1e4F;
constexpr std::uint8_t kUint16 = 4;
constexpr std::uint8_t kUint32 = 6;
constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint8_t kFloat64 = 8;

[[noreturn]] void refuse_message(const std::string& what) { throw std::invalid_argument(what); }

std::size_t size_of_type(std::uint8_t datatype) {
  static constexpr std::size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
  return datatype < std::size(kSizes) ? kSizes[datatype] : 0;
}

template <typename T>
T value_at(const std::uint8_t* at) {
  T value{};
  std::memcpy(&value, at, sizeof(T));
  return value;
}

/// Reads one column of a cloud.
class Column {
 public:
  Column(const RosPointCloud& cloud, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      for (const RosField& field : cloud.fields) {
        if (field.name == name && !field_) take(cloud, field);
      }
    }
  }

  explicit operator bool() const { return field_.has_value(); }
  bool is_integer() const { return field_ && field_->datatype < kFloat32; }

  double at(const std::uint8_t* point) const {
    const std::uint8_t* place = point + field_->offset;
    switch (field_->datatype) {
      case 1:
        return value_at<std::int8_t>(place);
      case 2:
        return value_at<std::uint8_t>(place);
      case 3:
        return value_at<std::int16_t>(place);
      case kUint16:
        return value_at<std::uint16_t>(place);
      case 5:
        return value_at<std::int32_t>(place);
      case kUint32:
        return value_at<std::uint32_t>(place);
      case kFloat32:
        return value_at<float>(place);
      default:
        return value_at<double>(place);
    }
  }

  /// An absolute time does not fit a double's nanoseconds: whole seconds and the rest are converted one by one.
  std::int64_t nanoseconds_since(std::int64_t stamp_ns, const std::uint8_t* point) const {
    const double value = at(point);
    if (!std::isfinite(value) || std::abs(value) > 9e9) return std::numeric_limits<std::int64_t>::max();
    if (is_integer()) return static_cast<std::int64_t>(value);
    const double whole = std::floor(value);
    const std::int64_t time_ns = static_cast<std::int64_t>(whole) * 1'000'000'000 +
                                 static_cast<std::int64_t>(std::llround(1e9 * (value - whole)));
    return value > kAbsoluteTime_s ? time_ns - stamp_ns : time_ns;
  }

 private:
  void take(const RosPointCloud& cloud, const RosField& field) {
    const std::size_t size = size_of_type(field.datatype);
    if (size == 0 || field.offset > cloud.point_step || size > cloud.point_step - field.offset) {
      refuse_message("a cloud's field " + field.name.substr(0, 40) + " is of no known type or lies outside its points");
    }
    field_ = field;
  }

  std::optional<RosField> field_;
};

void check_sizes(const RosPointCloud& cloud) {
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  const std::uint64_t row = cloud.row_step > 0 ? cloud.row_step : std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.is_bigendian) refuse_message("a cloud of big-endian numbers, which is not read");
  if (points > kMostCloudPoints)
    refuse_message("a cloud of " + std::to_string(points) + " points, of which 8 million are allowed");
  if (points > 0 && (cloud.point_step == 0 || row < std::uint64_t{cloud.width} * cloud.point_step ||
                     cloud.data.size() / row < cloud.height)) {
    refuse_message("a cloud of " + std::to_string(cloud.data.size()) + " bytes, which its sizes do not fit");
  }
}

void check_sizes(const RosImage& image, std::size_t pixel_bytes) {
  const bool small =
      image.width > 0 && image.height > 0 && image.width <= kMostImageSide && image.height <= kMostImageSide;
  const std::size_t row = image.width * pixel_bytes;
  if (!small || image.step < row || image.data.size() / image.step < image.height) {
    refuse_message("an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) + " with " +
                   std::to_string(image.data.size()) + " bytes, which do not fit or are too many");
  }
  if (image.is_bigendian && pixel_bytes > 1 && pixel_bytes != 3)
    refuse_message("an image of big-endian numbers, which is not read");
}

/// Moves the scan's start so that no point is before it, and ends it with its last point.
void settle_times(std::int64_t stamp_ns, const std::vector<std::int64_t>& offsets_ns, LidarScan& scan) {
  const auto [least, most] = std::minmax_element(offsets_ns.begin(), offsets_ns.end());
  const std::int64_t first_ns = offsets_ns.empty() ? 0 : std::min<std::int64_t>(*least, 0);
  scan.stamp_ns = stamp_ns + first_ns;
  scan.end_ns = scan.stamp_ns + (offsets_ns.empty() ? 0 : *most - first_ns) + 1;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    scan.points[i].offset_ns = static_cast<std::int32_t>(offsets_ns[i] - first_ns);
  }
  const auto earlier = [](const LidarPoint& a, const LidarPoint& b) { return a.offset_ns < b.offset_ns; };
  std::stable_sort(scan.points.begin(), scan.points.end(), earlier);
}

template <typename T>
void put(std::vector<std::uint8_t>& data, std::size_t at, T value) {
  std::memcpy(data.data() + at, &value, sizeof(T));
}

}  // namespace

LidarScan scan_of(const RosPointCloud& cloud) {
  check_sizes(cloud);
  const Column x(cloud, {"x"}), y(cloud, {"y"}), z(cloud, {"z"}), intensity(cloud, {"intensity"});
  const Column ring(cloud, {"ring", "channel", "line"});
  const Column time(cloud, {"time", "t", "timestamp", "time_stamp", "offset_time"});
  if (!x || !y || !z) refuse_message("a cloud without fields x, y and z");
  if (!ring && cloud.height < 2 && cloud.width > 0)
    refuse_message("a cloud without a field ring, and not organised in rows");
  const std::size_t row_bytes = cloud.row_step > 0 ? cloud.row_step : std::size_t{cloud.width} * cloud.point_step;
  LidarScan scan;
  std::vector<std::int64_t> offsets_ns;
  for (std::size_t row = 0; row < cloud.height; ++row) {
    for (std::size_t column = 0; column < cloud.width; ++column) {
      const std::uint8_t* at = cloud.data.data() + row * row_bytes + column * cloud.point_step;
      LidarPoint point;
      point.position = Eigen::Vector3d(x.at(at), y.at(at), z.at(at)).cast<float>();
      const std::int64_t offset_ns = time ? time.nanoseconds_since(cloud.stamp_ns, at) : 0;
      const double number = ring ? ring.at(at) : static_cast<double>(cloud.height - 1 - row);
      const bool usable = point.position.allFinite() && !point.position.isZero(0.0F) &&
                          point.position.cwiseAbs().maxCoeff() <= kFurthestReturn_m && number >= 0.0 &&
                          number < 65536.0 && offset_ns >= -kFurthest_ns && offset_ns <= kFurthest_ns;
      if (!usable) continue;
      point.ring = static_cast<std::uint16_t>(number);
      if (intensity) point.intensity = static_cast<float>(intensity.at(at));
      if (!std::isfinite(point.intensity)) point.intensity = 0.0F;
      scan.points.push_back(point);
      offsets_ns.push_back(offset_ns);
    }
  }
  settle_times(cloud.stamp_ns, offsets_ns, scan);
  if (scan.end_ns - scan.stamp_ns > kFurthest_ns) refuse_message("a cloud that takes longer than 2 s");
  return scan;
}

RosPointCloud cloud_of(const LidarScan& scan) {
  constexpr std::uint32_t kPointBytes = 22;
  RosPointCloud cloud;
  cloud.stamp_ns = scan.stamp_ns;
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(scan.points.size());
  cloud.point_step = kPointBytes;
  cloud.row_step = cloud.width * kPointBytes;
  cloud.fields = {{"x", 0, kFloat32, 1},          {"y", 4, kFloat32, 1}, {"z", 8, kFloat32, 1},
                  {"intensity", 12, kFloat32, 1}, {"t", 16, kUint32, 1}, {"ring", 20, kUint16, 1}};
  cloud.data.resize(cloud.row_step);
  std::size_t at = 0;
  for (const LidarPoint& point : scan.points) {
    for (std::size_t i = 0; i < 3; ++i) put(cloud.data, at + 4 * i, point.position[static_cast<int>(i)]);
    put(cloud.data, at + 12, point.intensity);
    put(cloud.data, at + 16, static_cast<std::uint32_t>(std::max(point.offset_ns, 0)));
    put(cloud.data, at + 20, point.ring);
    at += kPointBytes;
  }
  return cloud;
}

CameraFrame frame_of(const RosImage& image, int camera_id) {
  struct Layout {
    const char* encoding;
    std::size_t bytes, red, green, blue;
  };
  static constexpr Layout kLayouts[] = {{"mono8", 1, 0, 0, 0}, {"8UC1", 1, 0, 0, 0},  {"rgb8", 3, 0, 1, 2},
                                        {"bgr8", 3, 2, 1, 0},  {"rgba8", 4, 0, 1, 2}, {"bgra8", 4, 2, 1, 0}};
  const auto* layout = std::find_if(std::begin(kLayouts), std::end(kLayouts),
                                    [&](const Layout& known) { return image.encoding == known.encoding; });
  if (layout == std::end(kLayouts)) {
    refuse_message("an image of encoding '" + image.encoding.substr(0, 40) +
                   "'; read are mono8, 8UC1, rgb8, bgr8, rgba8, bgra8");
  }
  check_sizes(image, layout->bytes);
  CameraFrame frame{image.stamp_ns, camera_id, static_cast<int>(image.width), static_cast<int>(image.height), {}};
  frame.pixels.reserve(std::size_t{image.width} * image.height);
  for (std::size_t row = 0; row < image.height; ++row) {
    const std::uint8_t* at = image.data.data() + row * image.step;
    for (std::size_t column = 0; column < image.width; ++column, at += layout->bytes) {
      // BT.601's weights in 1/1000; of equal parts they make the same.
      const unsigned grey = 299U * at[layout->red] + 587U * at[layout->green] + 114U * at[layout->blue];
      frame.pixels.push_back(static_cast<std::uint8_t>((grey + 500U) / 1000U));
    }
  }
  return frame;
}

DepthFrame depth_of(const RosImage& image, int camera_id) {
  const bool metres = image.encoding == "32FC1";
  if (!metres && image.encoding != "16UC1" && image.encoding != "mono16") {
    refuse_message("a depth image of encoding '" + image.encoding.substr(0, 40) +
                   "'; read are 32FC1, 16UC1 and mono16");
  }
  const std::size_t bytes = metres ? 4 : 2;
  check_sizes(image, bytes);
  DepthFrame frame{image.stamp_ns, camera_id, static_cast<int>(image.width), static_cast<int>(image.height), {}};
  frame.depth_m.reserve(std::size_t{image.width} * image.height);
  for (std::size_t row = 0; row < image.height; ++row) {
    const std::uint8_t* at = image.data.data() + row * image.step;
    for (std::size_t column = 0; column < image.width; ++column, at += bytes) {
      frame.depth_m.push_back(metres ? value_at<float>(at) : 1e-3F * static_cast<float>(value_at<std::uint16_t>(at)));
    }
  }
  return frame;
}

RosImage image_of(const CameraFrame& frame) {
  RosImage image;
  image.stamp_ns = frame.stamp_ns;
  image.height = static_cast<std::uint32_t>(frame.height);
  image.width = static_cast<std::uint32_t>(frame.width);
  image.encoding = "mono8";
  image.step = image.width;
  image.data = frame.pixels;
  return image;
}

RosImage image_of(const DepthFrame& frame) {
  RosImage image;
  image.stamp_ns = frame.stamp_ns;
  image.height = static_cast<std::uint32_t>(frame.height);
  image.width = static_cast<std::uint32_t>(frame.width);
  image.encoding = "32FC1";
  image.step = image.width * static_cast<std::uint32_t>(sizeof(float));
  image.data.resize(frame.depth_m.size() * sizeof(float));
  if (!image.data.empty()) std::memcpy(image.data.data(), frame.depth_m.data(), image.data.size());
  return image;
}

}  // namespace plumbline
