#include "sim/renderer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/gl_context.h"
#include "sim/render_chunks.h"
#include "sim/shaders.h"
#include "sim/textures.h"

namespace plumbline {
namespace {

constexpr std::size_t kMaxLayers = 8;  // of 11 MB and some 90 ms of one core each

RenderView checked(const RenderView& view) {
  const auto require = [](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(std::string("RenderView: ") + rule);
  };
  require(view.width > 0 && view.height > 0, "width and height must be positive");
  require(view.fx > 0.0 && view.fy > 0.0, "fx and fy must be positive");
  require(view.near_m > 0.0 && view.far_m > view.near_m, "0 < near_m < far_m must hold");
  return view;
}

/// The texture layer of each material. Those that show no texture share one; so do those of one pattern when there are
/// very many.
struct Layers {
  std::vector<Material> drawn;  ///< the materials whose textures become layers
  std::vector<int> of_material;

  explicit Layers(const std::vector<Material>& materials) {
    for (Material material : materials) {
      if (material.contrast == 0.0F) material.pattern = Material::Pattern::kPlain;
      const auto shared = std::find_if(drawn.begin(), drawn.end(), [&](const Material& other) {
        return other.pattern == material.pattern &&
               (drawn.size() >= kMaxLayers || material.pattern == Material::Pattern::kPlain);
      });
      of_material.push_back(static_cast<int>(shared - drawn.begin()));
      if (shared == drawn.end()) drawn.push_back(material);
    }
  }
};

/// Clip coordinates whose y runs down the image and whose depth is reversed: 1 at near_m, 0 at far_m.
Eigen::Matrix4d clip_from_camera(const RenderView& view) {
  // A pixel's centre is at integer coordinates for us and half a pixel further for OpenGL.
  const double depth = view.far_m - view.near_m;
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip(0, 0) = 2.0 * view.fx / view.width;
  clip(0, 2) = 2.0 * (view.cx + 0.5) / view.width - 1.0;
  clip(1, 1) = 2.0 * view.fy / view.height;
  clip(1, 2) = 2.0 * (view.cy + 0.5) / view.height - 1.0;
  clip(2, 2) = -view.near_m / depth;
  clip(2, 3) = view.near_m * view.far_m / depth;
  clip(3, 2) = 1.0;
  return clip;
}

GlContext::Matrix column_major(const Eigen::Matrix4d& matrix) {
  GlContext::Matrix out;
  Eigen::Map<Eigen::Matrix4f>(out.data()) = matrix.cast<float>();
  return out;
}

/// Whether a box lies wholly outside one of the planes -w <= x, y <= w and z <= w of clip space.
bool outside_view(const Eigen::AlignedBox3d& box, const Eigen::Matrix4d& clip_from_world) {
  Eigen::Matrix<double, 5, 4> planes;
  planes.row(0) = clip_from_world.row(3) + clip_from_world.row(0);
  planes.row(1) = clip_from_world.row(3) - clip_from_world.row(0);
  planes.row(2) = clip_from_world.row(3) + clip_from_world.row(1);
  planes.row(3) = clip_from_world.row(3) - clip_from_world.row(1);
  planes.row(4) = clip_from_world.row(2);
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d normal = planes.row(i).head<3>();
    const Eigen::Vector3d innermost = (normal.array() > 0.0).select(box.max(), box.min());
    if (normal.dot(innermost) + planes(i, 3) < 0.0) return true;
  }
  return false;
}

/// A chunk as the graphics library has it.
struct DrawnChunk {
  Eigen::Vector3d origin;
  Eigen::AlignedBox3d bounds;
  std::uint32_t mesh = 0;
  int index_count = 0;
};

}  // namespace

struct Renderer::Impl {
  Impl(const World& world, const RenderView& render_view, const RendererOptions& render_options);

  void upload_textures(const World& world, const std::vector<Material>& materials);
  void upload(const RenderChunk& chunk);
  std::vector<const DrawnChunk*> visible_chunks(const Pose& world_from_camera) const;
  void draw(const std::vector<const DrawnChunk*>& chunks, const Pose& world_from_camera, double light_factor);
  void read_depth();

  RenderView view;
  RendererOptions options;
  double sky_luminance;
  GlContext gl;
  GlContext::Program program;
  std::vector<DrawnChunk> chunks;
  RadianceImage image;
};

Renderer::Impl::Impl(const World& world, const RenderView& render_view, const RendererOptions& render_options)
    : view(checked(render_view)),
      options(render_options),
      sky_luminance(world.sky_luminance()),
      gl(view.width, view.height, options.threads),
      program(gl.make_program(world_vertex_shader(), world_fragment_shader())) {
  image.width = view.width;
  image.height = view.height;
  const Layers layers(world.materials());
  upload_textures(world, layers.drawn);
  const RenderScene scene = make_render_scene(world, layers.of_material, view.far_m);
  gl.make_texture(2, scene.light_map.width, scene.light_map.height, scene.light_map.lux);
  for (const RenderChunk& chunk : scene.chunks) upload(chunk);
}

void Renderer::Impl::upload_textures(const World& world, const std::vector<Material>& materials) {
  if (materials.empty()) return;
  const std::vector<SurfaceTextures> textures = make_textures(materials, world.seed());
  std::vector<const std::vector<std::vector<float>>*> structure;
  std::vector<const std::vector<std::vector<float>>*> wear;
  for (const SurfaceTextures& surface : textures) {
    structure.push_back(&surface.structure.levels);
    wear.push_back(&surface.wear.levels);
  }
  gl.make_texture_array(0, kTextureSize, structure);
  gl.make_texture_array(1, kTextureSize, wear);
}

void Renderer::Impl::upload(const RenderChunk& chunk) {
  DrawnChunk drawn;
  drawn.origin = chunk.origin;
  drawn.bounds = chunk.bounds;
  drawn.index_count = static_cast<int>(chunk.indices.size());
  constexpr std::size_t kFloats = sizeof(RenderVertex) / sizeof(float);
  drawn.mesh = gl.make_mesh({chunk.vertices.front().position.data(), chunk.vertices.size() * kFloats},
                            RenderVertex::kAttributeSizes, chunk.indices);
  chunks.push_back(std::move(drawn));
}

/// Nearest first, so that what they hide is never shaded.
std::vector<const DrawnChunk*> Renderer::Impl::visible_chunks(const Pose& world_from_camera) const {
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  camera_from_world.linear() = world_from_camera.rotation.conjugate().toRotationMatrix();
  camera_from_world.translation() = camera_from_world.linear() * -world_from_camera.translation;
  const Eigen::Matrix4d clip_from_world = clip_from_camera(view) * camera_from_world.matrix();

  std::vector<std::pair<double, const DrawnChunk*>> by_distance;
  for (const DrawnChunk& chunk : chunks) {
    if (outside_view(chunk.bounds, clip_from_world)) continue;
    by_distance.emplace_back(chunk.bounds.squaredExteriorDistance(world_from_camera.translation), &chunk);
  }
  std::stable_sort(by_distance.begin(), by_distance.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const DrawnChunk*> visible;
  for (const auto& [distance2, chunk] : by_distance) visible.push_back(chunk);
  return visible;
}

void Renderer::Impl::draw(const std::vector<const DrawnChunk*>& visible, const Pose& world_from_camera,
                          double light_factor) {
  gl.clear(static_cast<float>(sky_luminance * light_factor));
  gl.use(program, static_cast<float>(light_factor));
  const Eigen::Matrix4d projection = clip_from_camera(view);
  const Eigen::Matrix3d rotation = world_from_camera.rotation.conjugate().toRotationMatrix();
  Eigen::Matrix4d camera_from_chunk = Eigen::Matrix4d::Identity();
  camera_from_chunk.topLeftCorner<3, 3>() = rotation;
  for (const DrawnChunk* chunk : visible) {
    camera_from_chunk.topRightCorner<3, 1>() = rotation * (chunk->origin - world_from_camera.translation);
    gl.draw(program, chunk->mesh, chunk->index_count, column_major(projection * camera_from_chunk));
  }
}

void Renderer::Impl::read_depth() {
  gl.read_depth(image.depth_m);
  // Inverts clip_from_camera(): window depth = scale + offset / z.
  const auto scale = static_cast<float>(-view.near_m / (view.far_m - view.near_m));
  const auto offset = static_cast<float>(view.near_m * view.far_m / (view.far_m - view.near_m));
  for (float& depth : image.depth_m) depth = offset / (depth - scale);
}

Renderer::Renderer(const World& world, const RenderView& view, const RendererOptions& options)
    : impl_(std::make_unique<Impl>(world, view, options)) {}

Renderer::~Renderer() = default;

void Renderer::start(const RenderMoment& moment) {
  impl_->gl.make_current();
  impl_->draw(impl_->visible_chunks(moment.world_from_camera), moment.world_from_camera, moment.light_factor);
  impl_->gl.flush();
}

const RadianceImage& Renderer::finish() {
  impl_->gl.make_current();
  impl_->gl.read_luminance(impl_->image.luminance);
  if (impl_->options.depth) impl_->read_depth();
  return impl_->image;
}

const RadianceImage& Renderer::render(const RenderMoment& moment) {
  start(moment);
  return finish();
}

}  // namespace plumbline
