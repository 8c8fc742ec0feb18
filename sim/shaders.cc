#include "sim/shaders.h"

namespace plumbline {
namespace {

std::string header(const ShaderFeatures& features) {
  std::string text = "#version 450 core\n";
  if (features.light_map) text += "#define LIGHT_MAP\n";
  if (features.rig_lamp) text += "#define RIG_LAMP\n";
  if (features.fog) text += "#define FOG\n";
  if (features.colour) text += "#define COLOUR\n";
  if (features.body) text += "#define BODY\n";
  if (features.rig_lamp || features.fog) text += "#define IN_CAMERA\n";
  return text;
}

}  // namespace

std::string world_vertex_shader(const ShaderFeatures& features) {
  return header(features) + R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 place_on_textures;  // structure, wear [tiles]
layout(location = 2) in vec2 place_on_light_map; // [texels]
layout(location = 3) in vec4 surface;            // albedo / pi, contrast, texture layer, lux of sun and sky
layout(location = 4) in vec3 normal;
layout(location = 5) in vec3 tint;
layout(binding = 2) uniform sampler2D light_map;
uniform mat4 clip_from_chunk;
uniform mat4 camera_from_chunk;
uniform vec4 sun;
uniform float ambient_lux;
out vec4 place;
flat out vec4 look;
#ifdef LIGHT_MAP
out vec2 light_place;
#endif
#ifdef IN_CAMERA
out vec3 in_camera;
#endif
#ifdef RIG_LAMP
flat out vec3 normal_in_camera;
#endif
#ifdef COLOUR
flat out vec3 colour;
#endif

void main() {
  place = place_on_textures;
  look = surface;
#ifdef BODY
  look.w = ambient_lux + sun.w * max(dot(normal, sun.xyz), 0.0);
#endif
#ifdef LIGHT_MAP
  light_place = place_on_light_map / vec2(textureSize(light_map, 0));
#endif
#ifdef IN_CAMERA
  in_camera = (camera_from_chunk * vec4(position, 1.0)).xyz;
#endif
#ifdef RIG_LAMP
  normal_in_camera = mat3(camera_from_chunk) * normal;
#endif
#ifdef COLOUR
  colour = tint;
#endif
  gl_Position = clip_from_chunk * vec4(position, 1.0);
}
)";
}

std::string world_fragment_shader(const ShaderFeatures& features) {
  return header(features) + R"(
in vec4 place;
flat in vec4 look;
#ifdef LIGHT_MAP
in vec2 light_place;
#endif
#ifdef IN_CAMERA
in vec3 in_camera;
#endif
#ifdef RIG_LAMP
flat in vec3 normal_in_camera;
#endif
#ifdef COLOUR
flat in vec3 colour;
#endif
layout(binding = 0) uniform sampler2DArray structure;
layout(binding = 1) uniform sampler2DArray wear;
layout(binding = 2) uniform sampler2D light_map;
uniform float light_factor;
uniform vec4 fog;
uniform float rig_lamp_cd;
#ifdef COLOUR
layout(location = 0) out vec4 luminance;
#else
layout(location = 0) out float luminance;
#endif

void main() {
  vec2 tone = vec2(texture(structure, vec3(place.xy, look.z)).r, texture(wear, vec3(place.zw, look.z)).r);
  tone = 1.0 + look.y * (tone - 1.0);
  // A surface reflects no more light than it gets: look.x * tone.x * tone.y <= 1 / pi.
  float reflected = clamp(look.x * tone.x * tone.y, 0.0, 0.31831);
  float lux = look.w;
#ifdef LIGHT_MAP
  lux += textureLod(light_map, light_place, 0.0).r;
#endif
  lux *= light_factor;
#ifdef RIG_LAMP
  // The fourth power of the cosine: half the light within 33 degrees of the axis, as a head lamp's.
  float squared = dot(in_camera, in_camera);
  float axial = max(in_camera.z, 0.0) * max(in_camera.z, 0.0) / squared;
  lux += rig_lamp_cd * axial * axial * abs(dot(normal_in_camera, in_camera)) * inversesqrt(squared) / squared;
#endif
#ifdef COLOUR
  vec3 shown = reflected * lux * colour;
#else
  float shown = reflected * lux;
#endif
#ifdef FOG
  float seen = exp(-fog.x * length(in_camera));
#ifdef COLOUR
  shown = mix(fog.yzw * light_factor, shown, seen);
#else
  shown = mix(fog.y * light_factor, shown, seen);
#endif
#endif
#ifdef COLOUR
  luminance = vec4(shown, 1.0);
#else
  luminance = shown;
#endif
}
)";
}

}  // namespace plumbline
