#pragma once

#include <cstdint>
#include <memory>

#include "scenarios/scenario.h"
#include "scenarios/sensor_message.h"
#include "sensors/camera.h"
#include "sim/renderer.h"
#include "sim/rig_driver.h"
#include "sim/surroundings.h"

namespace plumbline {

/// The camera on the moving rig. The renderer's context belongs to the calling thread.
class FrameStream {
 public:
  /// The arguments must outlive the stream.
  FrameStream(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body);

  /// The next frame; null after the motion's end.
  std::unique_ptr<SensorMessage> next();

 private:
  CameraFrame expose(std::int64_t stamp_ns);

  const Scenario& scenario_;
  const std::int64_t end_ns_;
  RigDriver driver_;
  Renderer renderer_;
  Camera camera_;
  const std::int64_t period_ns_;
  std::int64_t frame_ = 0;  // index of the next one
};

}  // namespace plumbline
