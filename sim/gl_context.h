#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace plumbline {

/// An OpenGL 4.5 core context on OSMesa with the few operations that drawing the world takes. It draws into its own
/// framebuffer of 32-bit float luminance and depth. Depth is reversed, 1 at the near plane and 0 at the far one, where
/// float32 has digits to spare. Handles are OpenGL's names; all of them live as long as the context.
class GlContext {
 public:
  using Matrix = std::array<float, 16>;  ///< column-major

  struct Program {
    std::uint32_t handle = 0;
    std::int32_t matrix = -1;  ///< uniform mat4 clip_from_chunk
    std::int32_t light = -1;   ///< uniform float light_factor
  };

  /// @param threads  rasteriser threads besides the caller's, 0 for none. Mesa reads this once per process, when the
  ///                 first context is made; later contexts share its threads.
  /// @throws std::runtime_error if there is no such context.
  GlContext(int width, int height, int threads);
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
  /// Layers of one-channel mip levels, tiling and trilinearly filtered, bound to a texture unit for good. Floats,
  /// because llvmpipe filters them a quarter faster than bytes. layers[i] has levels of sizes size, size / 2, ..., 1.
  void make_texture_array(int unit, int size, std::span<const std::vector<std::vector<float>>* const> layers);
  /// One channel, bilinearly filtered, without mip levels.
  void make_texture(int unit, int width, int height, std::span<const float> texels);

  void clear(float luminance);
  void use(const Program& program, float light_factor);
  void draw(const Program& program, std::uint32_t mesh, int index_count, const Matrix& clip_from_chunk);

  /// Sets the rasteriser threads to work without waiting for them.
  void flush();
  void read_luminance(std::vector<float>& out);
  void read_depth(std::vector<float>& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
