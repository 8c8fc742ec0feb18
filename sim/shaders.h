#pragma once

#include <string>

namespace plumbline {

/// What a world's shaders take into account; every item costs time for each pixel, so there is a program for each
/// combination that is drawn.
struct ShaderFeatures {
  bool light_map = false;  ///< lamps' light from the light map, texture unit 2
  bool rig_lamp = false;   ///< a lamp at the camera that shines ahead
  bool fog = false;
  bool colour = false;
  bool body = false;  ///< a moving thing: the sun's light is worked out anew, lamps count as light from everywhere

  auto operator<=>(const ShaderFeatures&) const = default;
};

/// Vertices are RenderVertex.
std::string world_vertex_shader(const ShaderFeatures& features);
/// Structure and wear are texture arrays on the units 0 and 1.
std::string world_fragment_shader(const ShaderFeatures& features);

}  // namespace plumbline
