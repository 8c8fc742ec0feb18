#pragma once

#include <cstdint>

#include "scenarios/scenario.h"
#include "sensors/camera.h"
#include "sensors/depth_camera.h"
#include "sim/renderer.h"
#include "sim/rig_driver.h"
#include "sim/surroundings.h"

namespace plumbline {

/// What the cameras of a run have in common. All must outlive the cameras.
struct FilmSet {
  const Scenario& scenario;
  const Surroundings& surroundings;
  RigDriver& driver;
};

/// Draws what a camera on the pack sees at a time, to which the driver is moved on.
const RadianceImage& draw(const FilmSet& set, Renderer& renderer, const Pose& pack_from_camera, std::int64_t stamp_ns);

/// A camera that moves while it is exposed: as many pictures as the motion asks for, each from where the camera is.
/// Where it is so dark that no blur would show, one does.
class CameraOnRig {
 public:
  /// @param renderer  of the camera's view (Camera::view), perhaps shared; must outlive this
  CameraOnRig(const FilmSet& set, const Pose& pack_from_camera, Camera camera, Renderer& renderer);

  /// @param stamp_ns  the middle of the exposure
  RawImage take(std::int64_t stamp_ns, std::int64_t frame_index);

 private:
  int pictures_for(std::int64_t stamp_ns, const Shutter& shutter) const;
  /// Adds so many pictures; whether none of them shows anything.
  bool add_pictures(std::int64_t stamp_ns, const Shutter& shutter, int count);
  bool light_changes(std::int64_t stamp_ns, const Shutter& shutter) const;

  FilmSet set_;
  Pose pack_from_camera_;
  Camera camera_;
  Renderer& renderer_;
  bool was_unseen_ = false;  ///< the frame before
};

}  // namespace plumbline
