#include "sim/shaders.h"

namespace plumbline {

std::string world_vertex_shader() {
  return R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 place_on_textures;  // structure, wear [tiles]
layout(location = 2) in vec2 place_on_light_map; // [texels]
layout(location = 3) in vec3 surface;            // albedo / pi, contrast, texture layer
layout(binding = 2) uniform sampler2D light_map;
uniform mat4 clip_from_chunk;
out vec4 place;
out vec2 light_place;
flat out vec3 look;

void main() {
  place = place_on_textures;
  light_place = place_on_light_map / vec2(textureSize(light_map, 0));
  look = surface;
  gl_Position = clip_from_chunk * vec4(position, 1.0);
}
)";
}

std::string world_fragment_shader() {
  return R"(#version 450 core
in vec4 place;
in vec2 light_place;
flat in vec3 look;
layout(binding = 0) uniform sampler2DArray structure;
layout(binding = 1) uniform sampler2DArray wear;
layout(binding = 2) uniform sampler2D light_map;
uniform float light_factor;
layout(location = 0) out float luminance;

void main() {
  vec2 tone = vec2(texture(structure, vec3(place.xy, look.z)).r, texture(wear, vec3(place.zw, look.z)).r);
  tone = 1.0 + look.y * (tone - 1.0);
  // A surface reflects no more light than it gets: look.x * tone.x * tone.y <= 1 / pi.
  float reflected = clamp(look.x * tone.x * tone.y, 0.0, 0.31831);
  luminance = reflected * light_factor * textureLod(light_map, light_place, 0.0).r;
}
)";
}

}  // namespace plumbline
