#pragma once

#include <cstdint>
#include <vector>

#include "estimator/estimator.h"
#include "scenarios/scenario.h"
#include "sensors/information.h"
#include "sim/ray_scene.h"
#include "sim/world.h"

namespace plumbline {

/// What an estimator tracked in an image.
struct TrackedImage {
  std::int64_t stamp_ns = 0;
  std::vector<Eigen::Vector2f> pixels;
};

/// An image's true degeneracy.
struct ImageTrial {
  std::int64_t stamp_ns = 0;
  int features = 0;       ///< whose point is known
  DegeneracyLabel label;  ///< in C at the stamp
};

/// How well the points that the estimator tracked determine the camera's pose, each point found by a ray of the truth.
/// Of the main camera, whose clock is taken to be right.
/// @throws InputError as run_session
std::vector<ImageTrial> label_images(const Scenario& scenario, const World& world, const RayScene& rays,
                                     const std::vector<TrackedImage>& images);

}  // namespace plumbline
