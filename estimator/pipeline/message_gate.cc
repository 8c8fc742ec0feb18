#include "estimator/pipeline/message_gate.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace plumbline {
namespace {

constexpr double kLargestRate = 200.0;    // [rad/s], five times what consumer gyros can read
constexpr double kLargestForce = 2000.0;  // [m/s^2], 200 g
// [ns], 126 years about the epoch: differences of such stamps do not overflow.
constexpr std::int64_t kLargestStamp_ns = 4'000'000'000'000'000'000;
constexpr std::size_t kMostPoints = 20'000;    // in one frame
constexpr float kLargestCoordinate = 5000.0F;  // [m], beyond the reach of any lidar on a robot

bool finite(const ImuSample& s) { return s.angular_rate.allFinite() && s.specific_force.allFinite(); }

bool in_range(std::int64_t stamp_ns) { return stamp_ns > -kLargestStamp_ns && stamp_ns < kLargestStamp_ns; }

bool in_range(const ImuSample& s) {
  return in_range(s.stamp_ns) && s.angular_rate.norm() < kLargestRate && s.specific_force.norm() < kLargestForce;
}

bool in_reach(const LidarPoint& p) {
  return p.position.allFinite() && p.position.cwiseAbs().maxCoeff() < kLargestCoordinate;
}

std::size_t pixel_count(const GateImage& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

template <typename Frame>
bool has_size(const Frame& frame, std::size_t pixels, const GateImage& image) {
  return frame.width == image.width && frame.height == image.height && pixels == pixel_count(image);
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && !a.empty() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

bool same_points(const std::vector<LidarPoint>& a, const std::vector<LidarPoint>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const LidarPoint& p, const LidarPoint& q) {
    return p.offset_ns == q.offset_ns && p.position == q.position;
  });
}

}  // namespace

MessageUse message_use(const Calibration& calibration, const EstimatorConfig& config) {
  MessageUse use;
  if (calibration.has_camera && config.vision_enabled) {
    use.cameras[0] = use.depth_cameras[0] = {calibration.camera.width, calibration.camera.height};
    for (const FurtherCamera& camera : calibration.further_cameras) {
      const GateImage image{camera.intrinsics.width, camera.intrinsics.height};
      use.cameras[camera.camera_id] = use.depth_cameras[camera.camera_id] = image;
    }
  }
  use.lidar = calibration.has_lidar;
  use.own_body = OwnBodyMask(calibration);
  use.imu = config.imu_enabled;
  return use;
}

std::optional<ImuSample> MessageGate::admit(const ImuSample& received) {
  ImuSample sample = received;
  if (!use_.imu) {
    sample.angular_rate.setZero();
    sample.specific_force.setZero();
  }
  const char* fault = nullptr;
  if (!finite(sample)) {
    fault = "not finite";
  } else if (!in_range(sample)) {
    fault = "out of range";
  } else if (imu_ns_ && sample.stamp_ns <= *imu_ns_) {
    fault = "back in time";
  } else if (leaps(sample.stamp_ns)) {
    fault = "ahead of time";
  }
  if (fault != nullptr) {
    drop(Module::kImu, fault);
    return std::nullopt;
  }
  count_used(Module::kImu);
  imu_ns_ = sample.stamp_ns;
  return sample;
}

/// One wrong stamp far ahead would make all right ones after it go back in time.
bool MessageGate::leaps(std::int64_t stamp_ns) {
  if (!imu_ns_ || stamp_ns - *imu_ns_ <= kLongestGap_ns) {
    agreeing_ = 0;
    return false;
  }
  const bool agrees = leap_ns_ && stamp_ns > *leap_ns_ && stamp_ns - *leap_ns_ < kLongestGap_ns;
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  leap_ns_ = stamp_ns;
  if (agreeing_ < kAgreeing) return true;
  agreeing_ = 0;
  return false;
}

const char* MessageGate::untimely(std::int64_t stamp_ns, const std::optional<std::int64_t>& last_ns) const {
  if (!imu_ns_) return "before the start";
  if (!in_range(stamp_ns)) return "out of range";
  if (stamp_ns < *imu_ns_ - kLongestDelay_ns) return "late";
  if (stamp_ns > *imu_ns_ + kLongestLead_ns || held_.size() >= kMostWaiting) return "no IMU to go with";
  if (last_ns && stamp_ns <= *last_ns) return "back in time";
  return nullptr;
}

void MessageGate::admit(const CameraFrame& frame) {
  if (use_.cameras.empty()) return drop(Module::kVision, "disabled");
  const auto image = use_.cameras.find(frame.camera_id);
  if (image == use_.cameras.end()) return drop(Module::kVision, "further cameras are not used");
  if (!has_size(frame, frame.pixels.size(), image->second)) return drop(Module::kVision, "wrong size");
  CameraMemory& memory = cameras_[frame.camera_id];
  if (const char* reason = untimely(frame.stamp_ns, memory.last_ns)) return drop(Module::kVision, reason);
  if (frame.pixels == memory.pixels) return drop(Module::kVision, "repeats the last");
  memory = {frame.stamp_ns, frame.pixels};
  held_.emplace(frame.stamp_ns, frame);
}

void MessageGate::admit(const PointFrame& frame) {
  if (use_.cameras.empty()) return drop(Module::kVision, "disabled");
  if (!use_.cameras.contains(frame.camera_id)) return drop(Module::kVision, "further cameras are not used");
  std::optional<std::int64_t>& last_ns = last_points_ns_[frame.camera_id];
  if (const char* reason = untimely(frame.stamp_ns, last_ns)) return drop(Module::kVision, reason);
  if (frame.points.size() > kMostPoints) return drop(Module::kVision, "wrong size");
  if (frame.points.empty()) return drop(Module::kVision, "empty");
  const bool all_finite = std::all_of(frame.points.begin(), frame.points.end(),
                                      [](const PointFrame::Point& point) { return point.pixel.allFinite(); });
  if (!all_finite) return drop(Module::kVision, "not finite");
  last_ns = frame.stamp_ns;
  held_.emplace(frame.stamp_ns, frame);
}

void MessageGate::admit(const DepthFrame& frame) {
  const auto image = use_.depth_cameras.find(frame.camera_id);
  if (image == use_.depth_cameras.end()) return drop(Module::kVision, "depth images are not used");
  if (!has_size(frame, frame.depth_m.size(), image->second)) return drop(Module::kVision, "wrong size");
  DepthMemory& memory = depth_cameras_[frame.camera_id];
  if (const char* reason = untimely(frame.stamp_ns, memory.last_ns)) return drop(Module::kVision, reason);
  if (same_bits(frame.depth_m, memory.depth_m)) return drop(Module::kVision, "repeats the last");
  memory = {frame.stamp_ns, frame.depth_m};
  held_.emplace(frame.stamp_ns, frame);
}

void MessageGate::admit(const LidarScan& scan) {
  if (!use_.lidar) return drop(Module::kLidar, "disabled");
  const bool ends_open_sweep = scan.ends_sweep && open_sweep_ == scan.sweep;
  if (scan.points.empty() && !ends_open_sweep) return drop(Module::kLidar, "empty");
  if (scan.end_ns <= scan.stamp_ns) return drop(Module::kLidar, "back in time");
  if (const char* reason = untimely(scan.end_ns, last_scan_ns_)) return drop(Module::kLidar, reason);
  if (scan.stamp_ns < scan.end_ns - kLongestScan_ns) return drop(Module::kLidar, "too long");
  LidarScan usable = scan;
  std::erase_if(usable.points, [](const LidarPoint& point) { return !in_reach(point); });
  if (usable.points.empty() && !scan.points.empty() && !ends_open_sweep) return drop(Module::kLidar, "not finite");
  if (same_points(usable.points, last_points_)) return drop(Module::kLidar, "repeats the last");
  last_scan_ns_ = scan.end_ns;
  last_points_ = usable.points;
  std::erase_if(usable.points, [this](const LidarPoint& point) { return use_.own_body.covers(point.position); });
  if (usable.points.empty() && !ends_open_sweep) return drop(Module::kLidar, "nothing seen");
  open_sweep_ = scan.ends_sweep ? std::nullopt : std::optional(scan.sweep);
  held_.emplace(scan.end_ns, std::move(usable));
}

void MessageGate::start_at(std::int64_t stamp_ns) {
  while (const auto message = next(stamp_ns)) drop(module_of(*message), "before the start");
}

std::optional<MessageGate::Message> MessageGate::next(std::int64_t until_ns) {
  if (held_.empty() || held_.begin()->first > until_ns) return std::nullopt;
  return std::move(held_.extract(held_.begin()).mapped());
}

MessageCounts MessageGate::counts(Module module) const {
  const auto found = counts_.find(module);
  return found == counts_.end() ? MessageCounts{} : found->second;
}

std::int64_t stamp_of(const MessageGate::Message& message) {
  if (const auto* scan = std::get_if<LidarScan>(&message)) return scan->end_ns;
  return std::visit([](const auto& payload) { return payload.stamp_ns; }, message);
}

Module module_of(const MessageGate::Message& message) {
  return std::holds_alternative<LidarScan>(message) ? Module::kLidar : Module::kVision;
}

}  // namespace plumbline
