#pragma once

#include <string>

namespace plumbline {

/// The world's GLSL programs. Positions are relative to the chunk, so that float32 suffices far from the origin.
std::string world_vertex_shader();
/// Lambert's law under `lamp_count` point lamps. The count is compiled in: a loop of known length costs half of one
/// whose length is a uniform.
std::string world_fragment_shader(int lamp_count);

}  // namespace plumbline
