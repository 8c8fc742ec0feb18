#include "sim/shaders.h"

#include "sim/textures.h"

namespace plumbline {
namespace {

constexpr char kVertex[] = R"(#version 450 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 place_on_textures;  // structure, wear [tiles]
layout(location = 3) in vec3 surface;            // albedo / pi, contrast, texture layer
uniform mat4 clip_from_chunk;
out vec3 point;
out vec4 place;
flat out vec3 face_normal;
flat out vec3 look;

void main() {
  point = position;
  place = place_on_textures;
  face_normal = normal;
  look = surface;
  gl_Position = clip_from_chunk * vec4(position, 1.0);
}
)";

// The lamp's falloff is lamp_window() of sim/world.h.
constexpr char kFragment[] = R"(
in vec3 point;
in vec4 place;
flat in vec3 face_normal;
flat in vec3 look;
layout(binding = 0) uniform sampler2DArray structure;
layout(binding = 1) uniform sampler2DArray wear;
uniform vec2 light;  // ambient illuminance [lux], factor of all light
#if LAMPS > 0
uniform vec4 lamps[LAMPS];     // position in the chunk [m], intensity [cd]
uniform float windows[LAMPS];  // 1 / reach^2
#endif
layout(location = 0) out float luminance;

float illuminance() {
  float lux = light.x;
#if LAMPS > 0
  for (int i = 0; i < LAMPS; ++i) {
    vec3 to_lamp = lamps[i].xyz - point;
    float distance2 = dot(to_lamp, to_lamp);
    float inverse = inversesqrt(distance2);
    float ratio2 = distance2 * windows[i];
    float window = max(1.0 - ratio2 * ratio2, 0.0);
    lux += lamps[i].w * max(dot(to_lamp, face_normal), 0.0) * inverse * inverse * inverse * window * window;
  }
#endif
  return lux * light.y;
}

void main() {
  float upright = texture(structure, vec3(place.xy, look.z)).r;
  float turned = texture(wear, vec3(place.zw, look.z)).r;
  vec2 tone = 1.0 + look.y * TEXTURE_RANGE * (2.0 * vec2(upright, turned) - 1.0);
  // A surface reflects no more light than it gets: look.x * tone <= 1 / pi.
  luminance = clamp(look.x * tone.x * tone.y, 0.0, 0.3183) * illuminance();
}
)";

}  // namespace

std::string world_vertex_shader() { return kVertex; }

std::string world_fragment_shader(int lamp_count) {
  return "#version 450 core\n#define LAMPS " + std::to_string(lamp_count) + "\n#define TEXTURE_RANGE " +
         std::to_string(kTextureRange) + "\n" + kFragment;
}

}  // namespace plumbline
