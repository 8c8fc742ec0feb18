#pragma once

#include "scenarios/scenario.h"
#include "sim/trajectory.h"
#include "sim/world.h"

/// A wall, dark to the left and bright to the right, past which a camera moves sideways: blur and rolling shutter show
/// in where its edge lies and how wide it is.
namespace plumbline {

inline constexpr double kEdgeDistance_m = 2.0;  ///< from the camera to the wall

/// The wall, its edge in the x-z plane.
World edge_world();
/// To the left at constant speed, past the edge at half a second.
Trajectory sideways(double speed_mps);
/// A camera of the catalogue's wide640 with one exposure.
CameraModel exposed_for(double exposure_s);
/// The camera looking ahead from the body's origin, without noise and vignetting.
Scenario edge_scenario(const CameraModel& model);
/// The frame of camera 0 nearest to half a second, when the edge is in the image's middle.
CameraFrame middle_frame(const Scenario& scenario, double speed_mps);

/// Where an edge lies in a row, and how wide a box would blur it alike: from mean and variance of the row's slope.
struct Edge {
  double column = 0.0;
  double width_px = 0.0;
};
Edge edge_in_row(const CameraFrame& frame, int row);

/// Mean over the image's middle rows.
double mean_blur_px(const CameraFrame& frame);

/// The blur of an exposure at a speed, as measured and as the pinhole has it.
struct BlurCheck {
  double speed_mps = 0.0;
  double exposure_s = 0.0;
  double measured_px = 0.0;
  double expected_px = 0.0;
};
BlurCheck check_blur(double speed_mps, double exposure_s);

}  // namespace plumbline
