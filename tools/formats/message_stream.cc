#include "tools/formats/message_stream.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "scenarios/input_error.h"
#include "tools/formats/calibration_yaml.h"

namespace plumbline {
namespace {

static_assert(std::endian::native == std::endian::little, "fields are copied as they stand in memory");
static_assert(std::numeric_limits<float>::is_iec559 && std::numeric_limits<double>::is_iec559);

constexpr char kMagic[] = "PLUMBMSG";
constexpr std::size_t kMagicSize = sizeof kMagic - 1;
constexpr std::size_t kRecordHeadSize = 16;
constexpr std::size_t kImageHeadSize = 20;
constexpr std::size_t kScanHeadSize = 32;
constexpr std::size_t kChunk = 1 << 20;  // a size that lies costs no more memory than there are bytes

enum class Kind : std::uint32_t { kEnd = 0, kImu = 1, kCamera = 2, kDepth = 3, kLidar = 4 };

/// A point as it stands in a scan's record.
struct PointBytes {
  float x, y, z, intensity;
  std::int32_t offset_ns;
  std::uint16_t ring, zero;
};
constexpr std::size_t kPointSize = sizeof(PointBytes);
static_assert(kPointSize == 24);

/// What is copied as it is: a number, or several without gaps.
template <typename T>
concept Plain = std::is_arithmetic_v<T> || std::is_same_v<T, PointBytes>;

template <Plain T>
void append(std::string& bytes, T value) {
  char buffer[sizeof(T)];
  std::memcpy(buffer, &value, sizeof(T));
  bytes.append(buffer, sizeof(T));
}

template <Plain T>
void append(std::string& bytes, const std::vector<T>& values) {
  const std::size_t start = bytes.size();
  bytes.resize(start + values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data() + start, values.data(), values.size() * sizeof(T));
}

void append(std::string& bytes, const Eigen::Vector3d& vector) {
  for (const double value : {vector.x(), vector.y(), vector.z()}) append(bytes, value);
}

/// A record up to its payload, with room for the rest.
std::string record_head(Kind kind, std::size_t payload_size, std::int64_t delivery_ns) {
  if (payload_size > kMostPayloadBytes) {
    throw std::invalid_argument("a message of " + std::to_string(payload_size) + " bytes, of which " +
                                std::to_string(kMostPayloadBytes) + " are allowed");
  }
  std::string bytes;
  bytes.reserve(kRecordHeadSize + payload_size);
  append(bytes, static_cast<std::uint32_t>(kind));
  append(bytes, static_cast<std::uint32_t>(payload_size));
  append(bytes, delivery_ns);
  return bytes;
}

template <typename Frame, typename Pixel>
std::string image_record(Kind kind, const Frame& frame, const std::vector<Pixel>& pixels, std::int64_t delivery_ns) {
  const bool has_size = frame.width >= 0 && frame.height >= 0;
  if (!has_size ||
      static_cast<std::uint64_t>(frame.width) * static_cast<std::uint64_t>(frame.height) != pixels.size()) {
    throw std::invalid_argument("an image of " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
                                " with " + std::to_string(pixels.size()) + " pixels");
  }
  std::string bytes = record_head(kind, kImageHeadSize + pixels.size() * sizeof(Pixel), delivery_ns);
  append(bytes, frame.stamp_ns);
  append(bytes, std::int32_t{frame.camera_id});
  append(bytes, static_cast<std::uint32_t>(frame.width));
  append(bytes, static_cast<std::uint32_t>(frame.height));
  append(bytes, pixels);
  return bytes;
}

/// Takes fields off a payload. What is asked for must be there: sizes are checked before.
class Fields {
 public:
  explicit Fields(const std::string& bytes) : next_(bytes.data()) {}

  template <Plain T>
  T take() {
    T value{};
    std::memcpy(&value, next_, sizeof(T));
    next_ += sizeof(T);
    return value;
  }
  template <Plain T>
  std::vector<T> take(std::size_t count) {
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), next_, count * sizeof(T));
    next_ += count * sizeof(T);
    return values;
  }
  Eigen::Vector3d take_vector() {
    Eigen::Vector3d vector;
    for (double& value : vector) value = take<double>();
    return vector;
  }

 private:
  const char* next_;
};

/// A payload whose size is not the one that its fields ask for.
struct WrongSize {};

SensorPayload imu_of(const std::string& payload) {
  if (payload.size() != sizeof(std::int64_t) + 6 * sizeof(double)) throw WrongSize();
  Fields fields(payload);
  ImuSample sample;
  sample.stamp_ns = fields.take<std::int64_t>();
  sample.angular_rate = fields.take_vector();
  sample.specific_force = fields.take_vector();
  return sample;
}

template <typename Frame, typename Pixel>
SensorPayload image_of(const std::string& payload, std::vector<Pixel> Frame::*pixels) {
  if (payload.size() < kImageHeadSize) throw WrongSize();
  Fields fields(payload);
  Frame frame;
  frame.stamp_ns = fields.take<std::int64_t>();
  frame.camera_id = fields.take<std::int32_t>();
  const std::uint64_t width = fields.take<std::uint32_t>();
  const std::uint64_t height = fields.take<std::uint32_t>();
  // No overflow: each is below 2^28 where it is not refused.
  if (width > kMostPayloadBytes || height > kMostPayloadBytes ||
      width * height * sizeof(Pixel) != payload.size() - kImageHeadSize) {
    throw WrongSize();
  }
  frame.width = static_cast<int>(width);
  frame.height = static_cast<int>(height);
  frame.*pixels = fields.take<Pixel>(width * height);
  return frame;
}

SensorPayload scan_of(const std::string& payload) {
  if (payload.size() < kScanHeadSize) throw WrongSize();
  Fields fields(payload);
  LidarScan scan;
  scan.stamp_ns = fields.take<std::int64_t>();
  scan.end_ns = fields.take<std::int64_t>();
  scan.sweep = fields.take<std::int64_t>();
  scan.ends_sweep = fields.take<std::uint32_t>() != 0;
  const std::size_t count = fields.take<std::uint32_t>();
  if (count * kPointSize != payload.size() - kScanHeadSize) throw WrongSize();
  scan.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto point = fields.take<PointBytes>();
    scan.points.push_back({{point.x, point.y, point.z}, point.offset_ns, point.ring, point.intensity});
  }
  return scan;
}

SensorPayload payload_of(Kind kind, const std::string& payload) {
  switch (kind) {
    case Kind::kImu:
      return imu_of(payload);
    case Kind::kCamera:
      return image_of(payload, &CameraFrame::pixels);
    case Kind::kDepth:
      return image_of(payload, &DepthFrame::depth_m);
    case Kind::kLidar:
      return scan_of(payload);
    case Kind::kEnd:
      break;
  }
  throw WrongSize();
}

}  // namespace

std::string message_stream_header(const Calibration& calibration) {
  const std::string yaml = calibration_yaml(calibration);
  std::string bytes(kMagic, kMagicSize);
  append(bytes, kMessageStreamVersion);
  append(bytes, static_cast<std::uint32_t>(yaml.size()));
  return bytes + yaml;
}

std::string message_record(const ImuSample& sample, std::int64_t delivery_ns) {
  std::string bytes = record_head(Kind::kImu, sizeof(std::int64_t) + 6 * sizeof(double), delivery_ns);
  append(bytes, sample.stamp_ns);
  append(bytes, sample.angular_rate);
  append(bytes, sample.specific_force);
  return bytes;
}

std::string message_record(const CameraFrame& frame, std::int64_t delivery_ns) {
  return image_record(Kind::kCamera, frame, frame.pixels, delivery_ns);
}

std::string message_record(const DepthFrame& frame, std::int64_t delivery_ns) {
  return image_record(Kind::kDepth, frame, frame.depth_m, delivery_ns);
}

std::string message_record(const LidarScan& scan, std::int64_t delivery_ns) {
  std::string bytes = record_head(Kind::kLidar, kScanHeadSize + scan.points.size() * kPointSize, delivery_ns);
  append(bytes, scan.stamp_ns);
  append(bytes, scan.end_ns);
  append(bytes, scan.sweep);
  append(bytes, std::uint32_t{scan.ends_sweep});
  append(bytes, static_cast<std::uint32_t>(scan.points.size()));
  for (const LidarPoint& point : scan.points) {
    const Eigen::Vector3f& p = point.position;
    append(bytes, PointBytes{p.x(), p.y(), p.z(), point.intensity, point.offset_ns, point.ring, 0});
  }
  return bytes;
}

std::string message_record(const SensorPayload& payload, std::int64_t delivery_ns) {
  return std::visit([&](const auto& message) { return message_record(message, delivery_ns); }, payload);
}

std::string message_end_record() { return record_head(Kind::kEnd, 0, 0); }

MessageStreamReader::MessageStreamReader(std::istream& stream, std::string origin)
    : stream_(stream), origin_(std::move(origin)) {
  if (read_bytes(kMagicSize, "its first bytes") != kMagic) fail("no message stream: it does not begin with PLUMBMSG");
  const std::string sizes = read_bytes(2 * sizeof(std::uint32_t), "its header");
  Fields fields(sizes);
  const auto version = fields.take<std::uint32_t>();
  if (version != kMessageStreamVersion) {
    fail("a message stream of version " + std::to_string(version) + "; this program reads version " +
         std::to_string(kMessageStreamVersion));
  }
  const auto size = fields.take<std::uint32_t>();
  if (size > kMostCalibrationBytes) {
    fail("a calibration of " + std::to_string(size) + " bytes, of which " + std::to_string(kMostCalibrationBytes) +
         " are allowed");
  }
  calibration_text_ = read_bytes(size, "the calibration");
  calibration_ = read_calibration_yaml(calibration_text_, origin_);
}

std::optional<SensorMessage> MessageStreamReader::read() {
  if (ended_) return std::nullopt;
  ++record_;
  const std::string head = read_bytes(kRecordHeadSize, "a record or the stream's end");
  Fields fields(head);
  const auto kind = fields.take<std::uint32_t>();
  const auto size = fields.take<std::uint32_t>();
  const auto delivery_ns = fields.take<std::int64_t>();
  if (kind > static_cast<std::uint32_t>(Kind::kLidar)) fail("unknown kind " + std::to_string(kind));
  if (size > kMostPayloadBytes) {
    fail("a payload of " + std::to_string(size) + " bytes, of which " + std::to_string(kMostPayloadBytes) +
         " are allowed");
  }
  if (Kind{kind} == Kind::kEnd) {
    ended_ = true;
    if (size != 0 || stream_.peek() != std::istream::traits_type::eof()) fail("the stream goes on after its end");
    return std::nullopt;
  }
  const std::string payload = read_bytes(size, "the payload");
  if (delivered_ns_ && delivery_ns < *delivered_ns_) fail("delivery_ns goes back");
  delivered_ns_ = delivery_ns;
  try {
    return SensorMessage{payload_of(Kind{kind}, payload), delivery_ns, 0.0, {}};
  } catch (const WrongSize&) {
    fail("a payload of " + std::to_string(size) + " bytes, which is not what its fields ask for");
  }
}

void MessageStreamReader::fail(const std::string& what) const {
  const std::string record = record_ == 0 ? "" : "record " + std::to_string(record_) + ", ";
  throw InputError(origin_ + ": " + record + "before byte " + std::to_string(place_) + ": " + what);
}

std::string MessageStreamReader::read_bytes(std::size_t size, const char* what) {
  std::string bytes;
  while (bytes.size() < size) {
    const std::size_t start = bytes.size();
    const std::size_t wanted = std::min(kChunk, size - start);
    bytes.resize(start + wanted);
    stream_.read(bytes.data() + start, static_cast<std::streamsize>(wanted));
    const auto got = static_cast<std::size_t>(stream_.gcount());
    place_ += got;
    if (got < wanted) fail(std::string("the stream was cut short: expected ") + what);
  }
  return bytes;
}

}  // namespace plumbline
