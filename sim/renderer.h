#pragma once

#include <memory>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/world.h"

namespace plumbline {

/// What the renderer needs of a camera: pinhole, u = fx x/z + cx with pixel centres at integer coordinates.
struct RenderView {
  int width = 640;
  int height = 360;
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  double near_m = 0.05;
  double far_m = 200.0;
};

/// Linear luminance and depth, row-major, top row first.
struct RadianceImage {
  int width = 0;
  int height = 0;
  std::vector<float> luminance;  ///< [cd/m^2]
  std::vector<float> depth_m;    ///< along the optical axis; far_m where nothing is
};

/// Draws the world with OpenGL 4.5 core on OSMesa, headless, into a 32-bit float framebuffer.
/// Construction, use and destruction belong to one thread (the GL context is current there).
class Renderer {
 public:
  /// @throws std::runtime_error if no OpenGL 4.5 context can be had.
  Renderer(const World& world, const RenderView& view);
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  ~Renderer();

  /// @param world_from_camera  optical frame (x right, y down, z forward)
  /// @param light_factor       multiplies all lamps and the ambient light
  /// The reference stays valid until the next call.
  const RadianceImage& render(const Pose& world_from_camera, double light_factor);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
