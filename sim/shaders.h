#pragma once

#include <string>

namespace plumbline {

/// The world's GLSL program. Positions are relative to the chunk, so that float32 suffices far from the origin.
std::string world_vertex_shader();
std::string world_fragment_shader();

}  // namespace plumbline
