#pragma once

#include <memory>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/surroundings.h"
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
  std::vector<float> depth_m;    ///< along the optical axis; far_m where nothing is; see RendererOptions
  std::vector<float> rgb;        ///< linear, three floats a pixel, Rec. 709 luminance as above; see RendererOptions
};

struct RendererOptions {
  /// llvmpipe's threads besides the caller's; the frames are the same whatever their number. Mesa reads it once per
  /// process: the first renderer decides for all that follow.
  int threads = 0;
  bool depth = true;                  ///< false leaves RadianceImage::depth_m empty and saves reading it back
  bool colour = false;                ///< also fills RadianceImage::rgb
  const OwnBody* own_body = nullptr;  ///< drawn where world_from_body puts it; must outlive the renderer
};

/// What a frame, or a sub-frame of it, shows.
struct RenderMoment {
  Pose world_from_camera;     ///< optical frame (x right, y down, z forward)
  Pose world_from_body;       ///< of the pack of sensors; places the own body
  double light_factor = 1.0;  ///< multiplies all lamps, the ambient light, the sun and the sky
  double time_s = 0.0;        ///< of the movers
};

/// Draws the world with OpenGL 4.5 core on OSMesa, headless, into a 32-bit float framebuffer. Surfaces are Lambertian:
/// luminance = albedo / pi * illuminance. Geoms and lamps stay as they are at construction: the illuminance is computed
/// once, into a light map, because lamps lit pixel by pixel cost about a millisecond a frame each. Limitations: nothing
/// casts a shadow, light does not bounce, edges are not anti-aliased, and surfaces are drawn from outside only.
/// Construction, use and destruction belong to one thread (the GL context is current there).
class Renderer {
 public:
  /// @throws std::invalid_argument naming the view's field that is out of range.
  /// @throws std::runtime_error if no OpenGL 4.5 context can be had.
  Renderer(const World& world, const RenderView& view, const RendererOptions& options = {});
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;
  ~Renderer();

  /// The reference stays valid until the next call.
  const RadianceImage& render(const RenderMoment& moment);

  /// The two halves of render(). With RendererOptions::threads > 0, the picture is drawn by those threads while the
  /// caller does something else between start() and finish().
  void start(const RenderMoment& moment);
  const RadianceImage& finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
