#include "sim/renderer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/gl_context.h"
#include "sim/render_chunks.h"
#include "sim/render_tiles.h"
#include "sim/shaders.h"
#include "sim/textures.h"

namespace plumbline {
namespace {

constexpr std::size_t kMaxLayers = 12;  // of 11 MB and some 90 ms of one core each
constexpr double kForget_m = 64.0;      // beyond what can be seen, a tile is kept this much further

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
  bool lit_by_lamps = false;
  bool two_sided = false;
  std::uint32_t mesh = 0;
  int index_count = 0;
};

struct DrawnTile {
  std::vector<DrawnChunk> chunks;
  std::uint32_t light_map = 0;  ///< 0: none
};

/// A thing that moves: chunks in its own frame.
struct DrawnBody {
  std::vector<DrawnChunk> chunks;
  double radius_m = 0.0;  ///< about its origin
};

/// One draw call, with the distance that decides its turn.
struct Visible {
  double distance2 = 0.0;
  const DrawnChunk* chunk = nullptr;
  std::uint32_t light_map = 0;
};

Eigen::Matrix4d matrix_of(const Pose& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.translation;
  return matrix;
}

/// The farthest that anything in the picture can be: far_m is measured along the axis only.
double farthest_seen(const RenderView& view) {
  const double x = std::max(view.cx, view.width - view.cx) / view.fx;
  const double y = std::max(view.cy, view.height - view.cy) / view.fy;
  return view.far_m * std::sqrt(1.0 + x * x + y * y);
}

/// What lamps give to a thing at a place, averaged over all directions that its sides may face: a quarter of what a
/// plate facing the lamp would get.
double mean_lamp_light(const std::vector<Lamp>& lamps, const Eigen::Vector3d& place) {
  double lux = 0.0;
  for (const Lamp& lamp : lamps) {
    const double distance = std::max((lamp.position - place).norm(), 0.5);
    lux += 0.25 * lamp.intensity_cd / (distance * distance) * lamp_window(distance, lamp.reach_m);
  }
  return lux;
}

/// Extinction by Koschmieder's law, where contrast falls to 2 %.
double extinction_per_m(const Atmosphere& air) { return 3.912 / air.fog_visibility_m + 3.912 / air.dust_visibility_m; }

/// The world's materials, and after them those of the own body.
std::vector<Material> all_materials(const World& world, const OwnBody* own_body) {
  std::vector<Material> materials = world.materials();
  if (own_body != nullptr) {
    const std::vector<Material>& own = own_body->world.materials();
    materials.insert(materials.end(), own.begin(), own.end());
  }
  return materials;
}

/// Rec. 709.
void fill_luminance(RadianceImage& image) {
  image.luminance.resize(image.rgb.size() / 3);
  for (std::size_t i = 0; i < image.luminance.size(); ++i) {
    const float* rgb = image.rgb.data() + 3 * i;
    image.luminance[i] = 0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2];
  }
}

}  // namespace

struct Renderer::Impl {
  Impl(const World& drawn_world, const RenderView& render_view, const RendererOptions& render_options);

  void upload_textures(const std::vector<Material>& materials);
  void make_bodies();
  DrawnChunk upload(const RenderChunk& chunk);
  DrawnBody upload_body(const World& of_world, const std::vector<int>& geoms, const Pose& world_from_body,
                        const std::vector<int>& layers);
  const DrawnTile& tile_at(const TileKey& key);
  void forget_tiles_far_from(const Eigen::Vector3d& place);
  std::vector<Visible> visible_chunks(const Pose& world_from_camera, const Eigen::Matrix4d& clip_from_world);
  void use(ShaderFeatures features);
  void draw(const DrawnChunk& chunk, const Pose& world_from_frame);
  void draw_body(const DrawnBody& body, const Pose& world_from_body);
  void begin(const RenderMoment& shown);
  void draw(const RenderMoment& shown);
  void read_depth();

  const World& world;
  RenderView view;
  RendererOptions options;
  double farthest_m;
  ShaderFeatures everywhere;          ///< what all programs take into account
  std::array<float, 3> background{};  ///< at a light factor of 1
  GlContext gl;
  std::map<ShaderFeatures, GlContext::Program> programs;
  const GlContext::Program* program = nullptr;
  RenderMoment moment;
  std::vector<int> layer_of_material;
  TileIndex index;
  std::map<TileKey, DrawnTile> tiles;
  std::vector<DrawnBody> movers;  ///< as world.movers()
  DrawnBody own_body;
  RadianceImage image;
};

Renderer::Impl::Impl(const World& drawn_world, const RenderView& render_view, const RendererOptions& render_options)
    : world(drawn_world),
      view(checked(render_view)),
      options(render_options),
      farthest_m(farthest_seen(view)),
      gl(view.width, view.height, options.colour, options.threads),
      index(world) {
  image.width = view.width;
  image.height = view.height;
  everywhere.colour = options.colour;
  everywhere.rig_lamp = world.rig_lamp_cd > 0.0;
  everywhere.fog = extinction_per_m(world.atmosphere) > 0.0;
  // What is far away in fog shines as the sky does, or as a white plate would that the ambient light falls on.
  const double sky = world.sky_luminance();
  const double haze = sky > 0.0 ? sky : world.ambient_lux() / std::numbers::pi;
  background.fill(static_cast<float>(everywhere.fog ? haze : sky));
  upload_textures(all_materials(world, options.own_body));
  make_bodies();
}

void Renderer::Impl::upload_textures(const std::vector<Material>& materials) {
  if (materials.empty()) return;
  const Layers layers(materials);
  layer_of_material = layers.of_material;
  const std::vector<SurfaceTextures> textures = make_textures(layers.drawn, world.seed());
  std::vector<const std::vector<std::vector<float>>*> structure;
  std::vector<const std::vector<std::vector<float>>*> wear;
  for (const SurfaceTextures& surface : textures) {
    structure.push_back(&surface.structure.levels);
    wear.push_back(&surface.wear.levels);
  }
  gl.make_texture_array(0, kTextureSize, structure);
  gl.make_texture_array(1, kTextureSize, wear);
}

void Renderer::Impl::make_bodies() {
  std::vector<std::vector<int>> geoms_of_mover(world.movers().size());
  for (std::size_t geom = 0; geom < static_cast<std::size_t>(world.geom_count()); ++geom) {
    const int mover = world.mover_of(static_cast<int>(geom));
    if (mover >= 0) geoms_of_mover[static_cast<std::size_t>(mover)].push_back(static_cast<int>(geom));
  }
  for (std::size_t i = 0; i < geoms_of_mover.size(); ++i) {
    movers.push_back(upload_body(world, geoms_of_mover[i], world.initial_pose_of_mover(i), layer_of_material));
  }
  if (options.own_body == nullptr) return;
  const World& own = options.own_body->world;
  std::vector<int> geoms;
  for (int geom = 0; geom < own.geom_count(); ++geom) {
    if (is_drawn(own, geom)) geoms.push_back(geom);
  }
  const auto first = layer_of_material.begin() + static_cast<std::ptrdiff_t>(world.materials().size());
  own_body = upload_body(own, geoms, Pose{}, {first, layer_of_material.end()});
}

DrawnBody Renderer::Impl::upload_body(const World& of_world, const std::vector<int>& geoms, const Pose& world_from_body,
                                      const std::vector<int>& layers) {
  DrawnBody body;
  for (const RenderChunk& chunk : make_body_chunks(of_world, geoms, world_from_body, layers)) {
    body.chunks.push_back(upload(chunk));
    body.radius_m =
        std::max(body.radius_m, chunk.bounds.min().cwiseAbs().cwiseMax(chunk.bounds.max().cwiseAbs()).norm());
  }
  return body;
}

DrawnChunk Renderer::Impl::upload(const RenderChunk& chunk) {
  DrawnChunk drawn{
      chunk.origin, chunk.bounds, chunk.lit_by_lamps, chunk.two_sided, 0, static_cast<int>(chunk.indices.size())};
  constexpr std::size_t kFloats = sizeof(RenderVertex) / sizeof(float);
  drawn.mesh = gl.make_mesh({chunk.vertices.front().position.data(), chunk.vertices.size() * kFloats},
                            RenderVertex::kAttributeSizes, chunk.indices);
  return drawn;
}

/// Made when it is first seen.
const DrawnTile& Renderer::Impl::tile_at(const TileKey& key) {
  const auto [entry, is_new] = tiles.try_emplace(key);
  DrawnTile& drawn = entry->second;
  if (!is_new) return drawn;
  const Eigen::AlignedBox3d box = index.box_of(key);
  const RenderTile tile =
      make_render_tile(world, index.geoms_in(key),
                       {Eigen::Vector2d(box.min().head<2>()), Eigen::Vector2d(box.max().head<2>())}, layer_of_material);
  for (const RenderChunk& chunk : tile.chunks) drawn.chunks.push_back(upload(chunk));
  const LightMap& light = tile.light_map;
  if (!light.lux.empty()) drawn.light_map = gl.make_texture(light.width, light.height, light.lux);
  return drawn;
}

void Renderer::Impl::forget_tiles_far_from(const Eigen::Vector3d& place) {
  std::erase_if(tiles, [&](const auto& entry) {
    if (index.box_of(entry.first).exteriorDistance(place) <= farthest_m + kForget_m) return false;
    for (const DrawnChunk& chunk : entry.second.chunks) gl.delete_mesh(chunk.mesh);
    if (entry.second.light_map != 0) gl.delete_texture(entry.second.light_map);
    return true;
  });
}

/// Nearest first, so that what they hide is never shaded.
std::vector<Visible> Renderer::Impl::visible_chunks(const Pose& world_from_camera,
                                                    const Eigen::Matrix4d& clip_from_world) {
  const Eigen::Vector3d& eye = world_from_camera.translation;
  std::vector<Visible> visible;
  for (const TileKey& key : index.near(eye, farthest_m)) {
    if (outside_view(index.box_of(key), clip_from_world)) continue;
    const DrawnTile& tile = tile_at(key);
    for (const DrawnChunk& chunk : tile.chunks) {
      if (outside_view(chunk.bounds, clip_from_world)) continue;
      visible.push_back({chunk.bounds.squaredExteriorDistance(eye), &chunk, tile.light_map});
    }
  }
  std::stable_sort(visible.begin(), visible.end(),
                   [](const Visible& a, const Visible& b) { return a.distance2 < b.distance2; });
  return visible;
}

void Renderer::Impl::use(ShaderFeatures features) {
  const auto [entry, is_new] = programs.try_emplace(features);
  if (is_new) entry->second = gl.make_program(world_vertex_shader(features), world_fragment_shader(features));
  if (program == &entry->second) return;
  program = &entry->second;
  gl.use(*program);
  gl.set(program->light_factor, static_cast<float>(moment.light_factor));
  gl.set(program->fog, std::array<float, 4>{static_cast<float>(extinction_per_m(world.atmosphere)), background[0],
                                            background[1], background[2]});
  gl.set(program->rig_lamp_cd, static_cast<float>(world.rig_lamp_cd));
}

void Renderer::Impl::draw(const DrawnChunk& chunk, const Pose& world_from_frame) {
  Pose world_from_chunk = world_from_frame;
  world_from_chunk.translation = world_from_frame * chunk.origin;
  const Eigen::Matrix4d camera_from_chunk = matrix_of(moment.world_from_camera.inverse() * world_from_chunk);
  gl.set(program->clip_from_chunk, column_major(clip_from_camera(view) * camera_from_chunk));
  gl.set(program->camera_from_chunk, column_major(camera_from_chunk));
  gl.draw_both_sides(chunk.two_sided);
  gl.draw(chunk.mesh, chunk.index_count);
}

void Renderer::Impl::draw_body(const DrawnBody& body, const Pose& world_from_body) {
  if (body.chunks.empty()) return;
  ShaderFeatures features = everywhere;
  features.body = true;
  use(features);
  const Eigen::Vector3f sun = (world_from_body.rotation.conjugate() * world.sun().direction_to_sun).cast<float>();
  const double ambient_lux = world.ambient_lux() + mean_lamp_light(world.lamps(), world_from_body.translation);
  gl.set(program->sun, std::array<float, 4>{sun.x(), sun.y(), sun.z(), static_cast<float>(world.sun().lux)});
  gl.set(program->ambient_lux, static_cast<float>(ambient_lux));
  for (const DrawnChunk& chunk : body.chunks) draw(chunk, world_from_body);
}

void Renderer::Impl::begin(const RenderMoment& shown) {
  moment = shown;
  program = nullptr;
  std::array<float, 3> clear = background;
  for (float& value : clear) value *= static_cast<float>(shown.light_factor);
  gl.clear(clear);
}

void Renderer::Impl::draw(const RenderMoment& shown) {
  begin(shown);
  const Pose& world_from_camera = shown.world_from_camera;
  forget_tiles_far_from(world_from_camera.translation);
  if (options.own_body != nullptr) draw_body(own_body, shown.world_from_body * options.own_body->body_from_vehicle);
  for (std::size_t i = 0; i < movers.size(); ++i) {
    const Pose world_from_mover = world.pose_of_mover(i, shown.time_s);
    const double distance = (world_from_mover.translation - world_from_camera.translation).norm();
    if (distance < farthest_m + movers[i].radius_m) draw_body(movers[i], world_from_mover);
  }
  const Eigen::Matrix4d clip_from_world = clip_from_camera(view) * matrix_of(world_from_camera.inverse());
  for (const Visible& item : visible_chunks(world_from_camera, clip_from_world)) {
    ShaderFeatures features = everywhere;
    features.light_map = item.chunk->lit_by_lamps && item.light_map != 0;
    use(features);
    if (features.light_map) gl.bind_texture(2, item.light_map);
    draw(*item.chunk, Pose{});
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
  impl_->draw(moment);
  impl_->gl.flush();
}

const RadianceImage& Renderer::finish() {
  impl_->gl.make_current();
  if (impl_->options.colour) {
    impl_->gl.read_rgb(impl_->image.rgb);
    fill_luminance(impl_->image);
  } else {
    impl_->gl.read_luminance(impl_->image.luminance);
  }
  if (impl_->options.depth) impl_->read_depth();
  return impl_->image;
}

const RadianceImage& Renderer::render(const RenderMoment& moment) {
  start(moment);
  return finish();
}

}  // namespace plumbline
