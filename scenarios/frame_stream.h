#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "scenarios/camera_on_rig.h"
#include "scenarios/scenario.h"
#include "scenarios/sensor_message.h"
#include "sim/renderer.h"
#include "sim/rig_driver.h"
#include "sim/surroundings.h"

namespace plumbline {

/// The frames of all cameras on the moving rig, in time order, camera 0 first at one time: 0 the main camera, 1 the
/// right one of a stereo pair, 2 the depth camera. The renderers' contexts belong to the calling thread.
class FrameStream {
 public:
  /// The arguments must outlive the stream.
  /// @param renderer_threads  besides the caller's: see RendererOptions::threads
  FrameStream(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body,
              int renderer_threads);

  /// The next frame; null after the motion's end.
  std::unique_ptr<SensorMessage> next();
  /// When the last light that the next frame can see has fallen: what it needs to know of the motion.
  std::int64_t next_over_ns() const;

 private:
  using Payload = SensorPayload;

  /// A camera's frames, half a period into each of its periods.
  struct Source {
    std::int64_t period_ns = 0;
    std::function<Payload(std::int64_t stamp_ns, std::int64_t frame)> take;
    std::int64_t frame = 0;  ///< index of the next one

    std::int64_t next_ns() const { return frame * period_ns + period_ns / 2; }
  };

  Source& next_source();
  Renderer& add_renderer(const RenderView& view, bool depth);
  void add_grey_camera(const Pose& pack_from_camera, Camera camera, int camera_id, Renderer& renderer);
  void add_grey_cameras();
  void add_depth_camera(const MountedDepthCamera& mounted);

  const Scenario& scenario_;
  const Surroundings surroundings_;
  const Trajectory& world_from_body_;
  const std::int64_t reach_ns_;  // from a stamp to the last light, at the longest exposure
  const int renderer_threads_;
  RigDriver driver_;
  std::vector<std::unique_ptr<Renderer>> renderers_;
  std::vector<Source> sources_;
};

}  // namespace plumbline
