#pragma once

#include "estimator/geometry/pose.h"
#include "sim/renderer.h"
#include "sim/surroundings.h"

namespace plumbline {

/// A camera between two moments.
struct CameraSweep {
  Pose world_from_camera_at_begin;
  Pose world_from_camera_at_end;
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// How far the image of what the camera sees moves, in pixels, at its fastest: of a grid of rays, which reaches to the
/// view's border, each is cast to the surface that it meets, and that point, carried along if it is on a mover, is
/// projected at both moments. What is farther than 50 m counts as 50 m away.
double image_motion_px(const Surroundings& surroundings, const RenderView& view, const CameraSweep& sweep);

}  // namespace plumbline
