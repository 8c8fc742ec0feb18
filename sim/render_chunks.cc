#include "sim/render_chunks.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <tuple>

#include "sim/geom_mesh.h"
#include "sim/polygon_cut.h"
#include "sim/surface_mapping.h"

namespace plumbline {
namespace {

constexpr double kCell_m = 8.0;
constexpr double kLargeCell_m = 4.0 * kCell_m;
constexpr double kCurveTolerance_m = 0.005;
const Eigen::Vector3f kRec709(0.2126F, 0.7152F, 0.0722F);

/// Visits the triangles of a geom where it stands.
template <typename Visit>
void for_each_triangle(const World& world, int geom, double plane_extent_m, Visit visit) {
  const TriangleMesh mesh = mesh_of_geom(world.model(), geom, kCurveTolerance_m, plane_extent_m);
  const Pose pose = world.pose_of_geom(geom);
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  std::vector<Eigen::Vector3d> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    vertices.emplace_back(rotation * vertex.cast<double>() + pose.translation);
  }
  for (const auto& corners : mesh.triangles) visit(vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]);
}

/// What all vertices of one face share.
struct Face {
  Face(const World& world, int material_index, int layer, const Eigen::Vector3d& unit_normal,
       const SurfaceMapping& surface)
      : normal(unit_normal), mapping(surface.face(unit_normal)) {
    const Material& material = world.materials()[static_cast<std::size_t>(material_index)];
    two_sided = material.two_sided;
    const double towards_sun = normal.dot(world.sun().direction_to_sun);
    const double share = two_sided ? std::abs(towards_sun) : std::max(towards_sun, 0.0);
    look = {material.albedo / std::numbers::pi_v<float>, material.contrast, static_cast<float>(layer),
            static_cast<float>(world.ambient_lux() + world.sun().lux * share)};
    Eigen::Map<Eigen::Vector3f>(tint.data()) = material.tint / material.tint.dot(kRec709);
  }

  Eigen::Vector3d normal;
  SurfaceMapping::Face mapping;
  bool two_sided = false;
  std::array<float, 4> look{};
  std::array<float, 3> tint{};
};

std::uint32_t add_vertex(const Face& face, const Eigen::Vector3d& point, const Eigen::Vector2f& light,
                         RenderChunk& chunk) {
  // Whole tiles are taken away, the same ones all over the chunk, to keep float32 precise far from the origin.
  const Eigen::Vector4d whole_tiles = face.mapping(chunk.origin).array().floor();
  RenderVertex vertex;
  Eigen::Map<Eigen::Vector3f>(vertex.position.data()) = (point - chunk.origin).cast<float>();
  Eigen::Map<Eigen::Vector4f>(vertex.place.data()) = (face.mapping(point) - whole_tiles).cast<float>();
  Eigen::Map<Eigen::Vector2f>(vertex.light.data()) = light;
  Eigen::Map<Eigen::Vector3f>(vertex.normal.data()) = face.normal.cast<float>();
  vertex.surface = face.look;
  vertex.tint = face.tint;
  chunk.bounds.extend(point);
  chunk.vertices.push_back(vertex);
  return static_cast<std::uint32_t>(chunk.vertices.size() - 1);
}

void add_fan(const Face& face, const Polygon& piece, const std::vector<Eigen::Vector2f>& light, RenderChunk& chunk) {
  const auto first = static_cast<std::uint32_t>(chunk.vertices.size());
  for (std::size_t i = 0; i < piece.size(); ++i) add_vertex(face, piece[i], light[i], chunk);
  for (std::uint32_t i = 2; i < piece.size(); ++i) {
    chunk.indices.insert(chunk.indices.end(), {first, first + i - 1, first + i});
  }
}

class TileBuilder {
 public:
  explicit TileBuilder(const World& world) : world_(world), light_map_(world.lamps()) {}

  void add(const Polygon& piece, const Face& face) {
    // Foliage: many triangles, each far smaller than a cell; one belongs where its first corner lies.
    const bool small = (piece[1] - piece[0]).norm() + (piece[2] - piece[0]).norm() < kSmall_m && piece.size() == 3;
    if (small) {
      const Eigen::Vector3i at = (piece[0] / kLargeCell_m).array().floor().cast<int>();
      if (lamps_at(at, kLargeCell_m).empty()) return add_piece(piece, face, cell_at(at, kLargeCell_m, face.two_sided));
    }
    cut_into_cells(piece, kLargeCell_m, [&](const Eigen::Vector3i& large, const Polygon& in_large) {
      if (lamps_at(large, kLargeCell_m).empty()) {
        return add_piece(in_large, face, cell_at(large, kLargeCell_m, face.two_sided));
      }
      cut_into_cells(in_large, kCell_m, [&](const Eigen::Vector3i& cell, const Polygon& in_cell) {
        add_piece(in_cell, face, cell_at(cell, kCell_m, face.two_sided));
      });
    });
  }

  RenderTile take() {
    RenderTile tile;
    for (auto& [key, cell] : cells_) {
      if (!cell.chunk.indices.empty()) tile.chunks.push_back(std::move(cell.chunk));
    }
    if (light_map_.lit()) tile.light_map = light_map_.light();
    return tile;
  }

 private:
  static constexpr double kSmall_m = 1.0;
  using CellKey = std::tuple<double, int, int, int>;

  struct Cell {
    RenderChunk chunk;
    const std::vector<int>* lamps = nullptr;
  };

  const std::vector<int>& lamps_at(const Eigen::Vector3i& index, double cell_m) {
    const auto [entry, is_new] = lamps_.try_emplace({cell_m, index.x(), index.y(), index.z()});
    if (is_new) {
      const Eigen::Vector3d low = index.cast<double>() * cell_m;
      const Eigen::AlignedBox3d box(low, low + Eigen::Vector3d::Constant(cell_m));
      for (std::size_t i = 0; i < world_.lamps().size(); ++i) {
        const Lamp& lamp = world_.lamps()[i];
        if (box.exteriorDistance(lamp.position) < lamp.reach_m) entry->second.push_back(static_cast<int>(i));
      }
    }
    return entry->second;
  }

  Cell& cell_at(const Eigen::Vector3i& index, double cell_m, bool two_sided) {
    const auto [entry, is_new] = cells_.try_emplace({cell_m, index.x(), index.y(), index.z(), two_sided});
    Cell& cell = entry->second;
    if (is_new) {
      cell.chunk.origin = (index.cast<double>() + Eigen::Vector3d::Constant(0.5)) * cell_m;
      cell.chunk.two_sided = two_sided;
      cell.lamps = &lamps_at(index, cell_m);
      cell.chunk.lit_by_lamps = !cell.lamps->empty();
    }
    return cell;
  }

  void add_piece(const Polygon& piece, const Face& face, Cell& cell) {
    add_fan(face, piece, light_map_.add(piece, face.normal, *cell.lamps), cell.chunk);
  }

  const World& world_;
  LightMapBuilder light_map_;
  std::map<CellKey, std::vector<int>> lamps_;
  std::map<std::tuple<double, int, int, int, bool>, Cell> cells_;
};

Eigen::AlignedBox2d plan_of(const Polygon& polygon) {
  Eigen::AlignedBox2d plan;
  for (const Eigen::Vector3d& corner : polygon) plan.extend(Eigen::Vector2d(corner.head<2>()));
  return plan;
}

}  // namespace

bool is_drawn(const World& world, int geom) {
  const mjModel& model = world.model();
  const int material = model.geom_matid[geom];
  const float alpha = material >= 0 ? model.mat_rgba[4 * material + 3] : model.geom_rgba[4 * geom + 3];
  return alpha > 0.0F && model.geom_bodyid[geom] != world.rig_body();
}

RenderTile make_render_tile(const World& world, const std::vector<int>& geoms, const Eigen::AlignedBox2d& plan,
                            const std::vector<int>& layer_of_material) {
  TileBuilder builder(world);
  for (const int geom : geoms) {
    const int material = world.material_of(geom);
    const int layer = layer_of_material[static_cast<std::size_t>(material)];
    const SurfaceMapping mapping(world.model(), geom, world.seed());
    const double reach_m =
        (plan.center() - Eigen::Map<const Eigen::Vector2d>(world.data().geom_xpos + 3 * geom)).norm();
    for_each_triangle(world, geom, 2.0 * (reach_m + plan.sizes().norm()),
                      [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
                        const Eigen::Vector3d normal = (b - a).cross(c - a);
                        if (normal.squaredNorm() == 0.0) return;
                        Polygon piece{a, b, c};
                        const Eigen::AlignedBox2d extent = plan_of(piece);
                        if (!plan.intersects(extent)) return;
                        if (!plan.contains(extent)) clip_to_plan(plan, piece);
                        if (piece.size() < 3) return;
                        builder.add(piece, Face(world, material, layer, normal.normalized(), mapping));
                      });
  }
  return builder.take();
}

std::vector<RenderChunk> make_body_chunks(const World& world, const std::vector<int>& geoms,
                                          const Pose& world_from_body, const std::vector<int>& layer_of_material) {
  std::array<RenderChunk, 2> chunks;
  chunks[1].two_sided = true;
  const Pose body_from_world = world_from_body.inverse();
  const std::vector<Eigen::Vector2f> unlit(3, Eigen::Vector2f::Zero());
  for (const int geom : geoms) {
    const int material = world.material_of(geom);
    const int layer = layer_of_material[static_cast<std::size_t>(material)];
    const SurfaceMapping mapping(world.model(), geom, world.seed());
    for_each_triangle(world, geom, 1.0,
                      [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
                        const Polygon piece{body_from_world * a, body_from_world * b, body_from_world * c};
                        const Eigen::Vector3d normal = (piece[1] - piece[0]).cross(piece[2] - piece[0]);
                        if (normal.squaredNorm() == 0.0) return;
                        const Face face(world, material, layer, normal.normalized(), mapping);
                        add_fan(face, piece, unlit, chunks[face.two_sided ? 1 : 0]);
                      });
  }
  std::vector<RenderChunk> drawn;
  for (RenderChunk& chunk : chunks) {
    if (!chunk.indices.empty()) drawn.push_back(std::move(chunk));
  }
  return drawn;
}

}  // namespace plumbline
