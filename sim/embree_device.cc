#include "sim/embree_device.h"

#include <embree3/rtcore.h>

#include <stdexcept>

namespace plumbline {

void EmbreeDevice::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }

EmbreeDevice::EmbreeDevice() : device_(rtcNewDevice(nullptr)) {
  if (!device_) throw std::runtime_error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
  const auto keep = [](void* device, RTCError /*code*/, const char* message) {
    static_cast<EmbreeDevice*>(device)->keep_message(message);
  };
  rtcSetDeviceErrorFunction(device_.get(), keep, this);
}

void EmbreeDevice::keep_message(const char* message) {
  const std::lock_guard lock(mutex_);
  if (message_.empty()) message_ = message;
}

void EmbreeDevice::throw_if_failed() const {
  const std::lock_guard lock(mutex_);
  if (!message_.empty()) throw std::runtime_error("Embree: " + message_);
}

}  // namespace plumbline
