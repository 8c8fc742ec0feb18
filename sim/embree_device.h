#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <mutex>
#include <string>

namespace plumbline {

struct EmbreeRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

/// Embree's device. It reports through a C callback, which must not throw: the first message is kept.
class EmbreeDevice {
 public:
  /// @throws std::runtime_error
  EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const { return device_.get(); }
  /// @throws std::runtime_error with the first message, if there was any
  void throw_if_failed() const;

 private:
  static void record(void* self, RTCError code, const char* message);

  mutable std::mutex mutex_;
  std::string message_;
  std::unique_ptr<RTCDeviceTy, EmbreeRelease> device_;
};

}  // namespace plumbline
