#include "sim/embree_device.h"

#include <stdexcept>

namespace plumbline {

EmbreeDevice::EmbreeDevice() : device_(rtcNewDevice(nullptr)) {
  if (!device_) throw std::runtime_error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
  rtcSetDeviceErrorFunction(device_.get(), &EmbreeDevice::record, this);
}

void EmbreeDevice::record(void* self, RTCError /*code*/, const char* message) {
  auto& device = *static_cast<EmbreeDevice*>(self);
  const std::lock_guard lock(device.mutex_);
  if (device.message_.empty()) device.message_ = message;
}

void EmbreeDevice::throw_if_failed() const {
  const std::lock_guard lock(mutex_);
  if (!message_.empty()) throw std::runtime_error("Embree: " + message_);
}

}  // namespace plumbline
