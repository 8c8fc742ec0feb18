#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

/// An OpenGL 4.5 core context on OSMesa with the few operations that drawing the world takes. It draws into its own
/// framebuffer of 32-bit float luminance (or colour) and depth. Depth is reversed, 1 at the near plane and 0 at the far
/// one, where float32 has digits to spare. Handles are OpenGL's names; all of them live as long as the context.
class GlContext {
 public:
  using Matrix = std::array<float, 16>;  ///< column-major

  /// Uniforms by location; -1, which OpenGL ignores, where a shader has none of that name.
  struct Program {
    std::uint32_t handle = 0;
    std::int32_t clip_from_chunk = -1;    ///< mat4
    std::int32_t camera_from_chunk = -1;  ///< mat4
    std::int32_t light_factor = -1;       ///< float
    std::int32_t fog = -1;                ///< vec4: extinction [1/m], and the luminance of what is far away, rgb
    std::int32_t rig_lamp_cd = -1;        ///< float
    std::int32_t sun = -1;                ///< vec4: direction to it in the chunk's frame, lux
    std::int32_t ambient_lux = -1;        ///< float
  };

  /// @param colour   a framebuffer of red, green and blue in place of luminance
  /// @param threads  rasteriser threads besides the caller's, 0 for none. Mesa reads this once per process, when the
  ///                 first context is made; later contexts share its threads.
  /// @throws std::runtime_error if there is no such context.
  GlContext(int width, int height, bool colour, int threads);
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;
  ~GlContext();

  /// Makes this context the thread's current one; needed before anything else when a thread has several.
  void make_current();

  /// @throws std::runtime_error with the compiler's log.
  Program make_program(const std::string& vertex_shader, const std::string& fragment_shader);
  /// Interleaved float vertices; attribute i has attribute_sizes[i] components. Returns a vertex array object.
  std::uint32_t make_mesh(std::span<const float> vertices, std::span<const int> attribute_sizes,
                          std::span<const std::uint32_t> indices);
  void delete_mesh(std::uint32_t mesh);
  /// Layers of one-channel mip levels, tiling and trilinearly filtered, bound to a texture unit for good. Floats,
  /// because llvmpipe filters them a quarter faster than bytes. layers[i] has levels of sizes size, size / 2, ..., 1.
  void make_texture_array(int unit, int size, std::span<const std::vector<std::vector<float>>* const> layers);
  /// One channel, bilinearly filtered, without mip levels. Returns its name, for bind_texture().
  std::uint32_t make_texture(int width, int height, std::span<const float> texels);
  void bind_texture(int unit, std::uint32_t texture);
  void delete_texture(std::uint32_t texture);

  /// @param background  luminance, or red, green and blue
  void clear(const std::array<float, 3>& background);
  void use(const Program& program);
  void set(std::int32_t uniform, float value);
  void set(std::int32_t uniform, const std::array<float, 4>& value);
  void set(std::int32_t uniform, const Matrix& value);
  /// Whether triangles are drawn from behind, too.
  void draw_both_sides(bool both);
  void draw(std::uint32_t mesh, int index_count);

  /// Sets the rasteriser threads to work without waiting for them.
  void flush();
  /// The framebuffer's first channel, or all three.
  void read_luminance(std::vector<float>& out);
  void read_rgb(std::vector<float>& out);
  void read_depth(std::vector<float>& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
