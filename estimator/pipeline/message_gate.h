#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/lidar/own_body_mask.h"
#include "estimator/vision/point_frame.h"

/// The border between drivers and a pipeline: checks every message, puts camera, depth and lidar messages in order, and
/// holds them until the IMU has reached their stamps. What cannot be used is counted with its reason and dropped.
namespace plumbline {

/// A camera whose frames a pipeline uses, and the only size they may have.
struct GateImage {
  int width = 0;
  int height = 0;
};

/// What a pipeline uses; the rest is dropped with a reason.
struct MessageUse {
  std::map<int, GateImage> cameras;        ///< grey images, by camera id
  std::map<int, GateImage> depth_cameras;  ///< depth images, by camera id
  bool lidar = false;
  OwnBodyMask own_body;  ///< returns that it covers are left out
  bool imu = true;       ///< false: samples serve as a clock only, their readings are neither read nor checked
};

/// Grey images of camera 0 and grey or depth images of the further ones, where vision is on; the lidar where there is
/// one.
MessageUse message_use(const Calibration& calibration, const EstimatorConfig& config);

class MessageGate {
 public:
  using Message = std::variant<CameraFrame, PointFrame, DepthFrame, LidarScan>;

  explicit MessageGate(MessageUse use) : use_(std::move(use)) {}

  /// The sample to use, counted as used; with `imu` off its rate and force are zero. Empty: dropped, with these
  /// reasons. "not finite"; "out of range", more than any unit on a robot reads, or a stamp that is no time; "back in
  /// time", a stamp that does not come after the last one's; "ahead of time", a stamp further ahead than
  /// kLongestGap_ns, until kAgreeing samples in a row say the same.
  std::optional<ImuSample> admit(const ImuSample& sample);

  /// Checks a message and holds it until next() hands it out. Reasons besides the above:
  /// "disabled", "further cameras are not used", "depth images are not used"; "wrong size"; "empty";
  /// "repeats the last", whose driver is stuck, since noise makes no two alike; "too long", a scan over
  /// kLongestScan_ns; "before the start", without any IMU sample yet; "late", kLongestDelay_ns behind the IMU; "no IMU
  /// to go with", kLongestLead_ns ahead of it or more waiting than kMostWaiting. Returns of a scan that are not finite,
  /// or farther than any lidar sees, or from the carrier itself, are left out of it; one of which nothing is left is
  /// dropped as "nothing seen".
  void admit(const CameraFrame& frame);
  void admit(const PointFrame& frame);
  void admit(const DepthFrame& frame);
  void admit(const LidarScan& scan);

  /// Drops what was held up to a time, as "before the start": it has no motion to go with.
  void start_at(std::int64_t stamp_ns);
  /// The earliest held message stamped at or before a time, in order of arrival where stamps are equal. One that came
  /// late is handed out at the next call, however much earlier its stamp is than the last one's.
  std::optional<Message> next(std::int64_t until_ns);

  /// Counts a message that next() handed out.
  void count_used(Module module) { ++counts_[module].used; }
  void drop(Module module, const std::string& reason) { ++counts_[module].dropped[reason]; }
  MessageCounts counts(Module module) const;

  static constexpr std::int64_t kLongestDelay_ns = 500'000'000;
  static constexpr std::int64_t kLongestLead_ns = 3'000'000'000;
  static constexpr std::int64_t kLongestScan_ns = 2'000'000'000;
  static constexpr std::int64_t kLongestGap_ns = 10'000'000'000;
  static constexpr int kAgreeing = 20;
  static constexpr std::size_t kMostWaiting = 256;

 private:
  struct CameraMemory {
    std::optional<std::int64_t> last_ns;
    std::vector<std::uint8_t> pixels;
  };
  struct DepthMemory {
    std::optional<std::int64_t> last_ns;
    std::vector<float> depth_m;
  };

  bool leaps(std::int64_t stamp_ns);
  /// Why a stamp cannot be used, or null. @param last_ns  of the same stream
  const char* untimely(std::int64_t stamp_ns, const std::optional<std::int64_t>& last_ns) const;

  MessageUse use_;
  std::optional<std::int64_t> imu_ns_;   ///< stamp of the last sample used
  std::optional<std::int64_t> leap_ns_;  ///< stamp of the last sample refused as ahead of time
  int agreeing_ = 0;                     ///< samples in a row that are ahead of time alike
  std::map<int, CameraMemory> cameras_;
  std::map<int, std::optional<std::int64_t>> last_points_ns_;  ///< of point frames, by camera id
  std::map<int, DepthMemory> depth_cameras_;
  std::optional<std::int64_t> last_scan_ns_;
  std::vector<LidarPoint> last_points_;
  std::optional<std::int64_t> open_sweep_;  ///< of the last scan handed on, if it was not its sweep's last part
  std::multimap<std::int64_t, Message> held_;
  std::map<Module, MessageCounts> counts_;
};

/// The time at which a message can be used: of a scan its end.
std::int64_t stamp_of(const MessageGate::Message& message);
Module module_of(const MessageGate::Message& message);

}  // namespace plumbline
