#include "sensors/faults.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumbline {

const std::vector<std::string>& faulty_sensor_names() {
  static const std::vector<std::string> names{"imu", "camera", "lidar"};
  return names;
}

const std::vector<std::string>& fault_kind_names() {
  static const std::vector<std::string> names{"drop_out", "freeze",  "nan",       "duplicate",
                                              "reorder",  "partial", "saturated", "black"};
  return names;
}

bool can_befall(FaultySensor sensor, FaultKind kind) {
  switch (kind) {
    case FaultKind::kNan:
      return sensor != FaultySensor::kCamera;
    case FaultKind::kPartial:
      return sensor == FaultySensor::kLidar;
    case FaultKind::kSaturated:
    case FaultKind::kBlack:
      return sensor == FaultySensor::kCamera;
    default:
      return true;
  }
}

void spoil(ImuSample& sample, const Fault& fault, RandomStream& /*stream*/) {
  if (fault.kind != FaultKind::kNan) return;
  sample.angular_rate.setConstant(std::numeric_limits<double>::quiet_NaN());
  sample.specific_force.setConstant(std::numeric_limits<double>::quiet_NaN());
}

namespace {

bool spoils_images(const Fault& fault) {
  return fault.kind == FaultKind::kSaturated || fault.kind == FaultKind::kBlack;
}

/// Fills the upper rows, up to the fault's share of an image.
template <typename Pixel>
void fill_rows(std::vector<Pixel>& pixels, int width, int height, double share, Pixel value) {
  const auto rows = static_cast<std::size_t>(std::lround(share * height));
  std::fill_n(pixels.begin(), std::min(pixels.size(), rows * static_cast<std::size_t>(width)), value);
}

}  // namespace

void spoil(CameraFrame& frame, const Fault& fault, RandomStream& /*stream*/) {
  if (!spoils_images(fault)) return;
  const std::uint8_t value = fault.kind == FaultKind::kBlack ? 0 : 255;
  fill_rows(frame.pixels, frame.width, frame.height, fault.share, value);
}

void spoil(DepthFrame& frame, const Fault& fault, RandomStream& /*stream*/) {
  if (spoils_images(fault)) fill_rows(frame.depth_m, frame.width, frame.height, fault.share, 0.0F);
}

void spoil(LidarScan& scan, const Fault& fault, RandomStream& stream) {
  if (fault.kind == FaultKind::kPartial) {
    const double end_ns = fault.share * static_cast<double>(scan.end_ns - scan.stamp_ns);
    std::erase_if(scan.points, [&](const LidarPoint& point) { return point.offset_ns >= end_ns; });
  }
  if (fault.kind != FaultKind::kNan) return;
  for (LidarPoint& point : scan.points) {
    if (stream.uniform() < fault.share) point.position.setConstant(std::numeric_limits<float>::quiet_NaN());
  }
}

void freeze(ImuSample& message, const ImuSample& earlier) {
  message.angular_rate = earlier.angular_rate;
  message.specific_force = earlier.specific_force;
}

void freeze(CameraFrame& message, const CameraFrame& earlier) { message.pixels = earlier.pixels; }

void freeze(DepthFrame& message, const DepthFrame& earlier) { message.depth_m = earlier.depth_m; }

void freeze(LidarScan& message, const LidarScan& earlier) { message.points = earlier.points; }

FaultTrigger::FaultTrigger(const Fault& fault, std::uint64_t seed, std::size_t index)
    : fault_(fault), stream_(seed, "fault." + std::to_string(index)) {}

bool FaultTrigger::hits(std::int64_t true_ns) {
  const double time_s = static_cast<double>(true_ns) * 1e-9;
  return time_s >= fault_.start_s && time_s < fault_.end_s && stream_.uniform() < fault_.probability;
}

}  // namespace plumbline
