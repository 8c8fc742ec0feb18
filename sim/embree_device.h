#pragma once

#include <memory>
#include <mutex>
#include <string>

struct RTCDeviceTy;

namespace plumbline {

/// Embree's device. It reports through a C callback, which must not throw: the first message is kept.
class EmbreeDevice {
 public:
  /// @throws std::runtime_error
  EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDeviceTy* get() const { return device_.get(); }
  void keep_message(const char* message);
  /// @throws std::runtime_error with the first message, if there was any
  void throw_if_failed() const;

 private:
  struct Release {
    void operator()(RTCDeviceTy* device) const;
  };

  mutable std::mutex mutex_;
  std::string message_;
  std::unique_ptr<RTCDeviceTy, Release> device_;
};

}  // namespace plumbline
