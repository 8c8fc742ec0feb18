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
constexpr double kCurveTolerance_m = 0.005;

/// As mj_ray sees it: a geom whose material, or colour where it has none, is fully transparent is not there.
bool visible(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  return (material >= 0 ? model.mat_rgba[4 * material + 3] : model.geom_rgba[4 * geom + 3]) > 0.0F;
}

std::vector<int> drawn_geoms(const World& world) {
  std::vector<int> geoms;
  for (int geom = 0; geom < world.model().ngeom; ++geom) {
    if (visible(world.model(), geom) && world.model().geom_bodyid[geom] != world.rig_body()) geoms.push_back(geom);
  }
  return geoms;
}

/// The half-width that an infinite plane needs to lie under everything else and view_distance_m more.
double plane_extent(const World& world, const std::vector<int>& geoms, double view_distance_m) {
  double extent = 0.0;
  for (const int geom : geoms) {
    const Eigen::Map<const Eigen::Vector3d> centre(world.data().geom_xpos + 3 * geom);
    const double radius = std::max(world.model().geom_rbound[geom], 0.0);  // 0 for planes
    extent = std::max(extent, centre.cwiseAbs().maxCoeff() + radius);
  }
  return 2.0 * extent + view_distance_m;
}

class ChunkBuilder {
 public:
  ChunkBuilder(const World& world, double extent_m) : world_(world), light_map_(world.lamps(), world.ambient_lux()) {
    // At most some 64 by 64 large cells under an infinite plane.
    while (large_cell_m_ * 32.0 < extent_m) large_cell_m_ *= 2.0;
  }

  void add_triangle(const Polygon& triangle, const SurfaceMapping& mapping, int layer, const Material& material) {
    const Eigen::Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if (normal.squaredNorm() == 0.0) return;
    face_ = {normal.normalized(),
             mapping.face(normal.normalized()),
             {material.albedo / std::numbers::pi_v<float>, material.contrast, static_cast<float>(layer)}};
    cut_into_cells(triangle, large_cell_m_, [this](const Eigen::Vector3i& large_cell, const Polygon& piece) {
      Cell& large = cell_at(large_cell, large_cell_m_);
      if (large.lamps.empty()) return add_piece(piece, large);
      cut_into_cells(piece, kCell_m, [this](const Eigen::Vector3i& cell, const Polygon& small_piece) {
        add_piece(small_piece, cell_at(cell, kCell_m));
      });
    });
  }

  RenderScene take() {
    RenderScene scene;
    for (auto& [key, cell] : cells_) {
      if (!cell.chunk.indices.empty()) scene.chunks.push_back(std::move(cell.chunk));
    }
    scene.light_map = light_map_.light();
    return scene;
  }

 private:
  struct Face {
    Eigen::Vector3d normal;
    SurfaceMapping::Face mapping;
    std::array<float, 3> surface;
  };

  struct Cell {
    RenderChunk chunk;
    std::vector<int> lamps;  // that reach it
  };

  Cell& cell_at(const Eigen::Vector3i& index, double cell_m) {
    const auto [entry, is_new] = cells_.try_emplace({cell_m, index.x(), index.y(), index.z()});
    Cell& cell = entry->second;
    if (is_new) {
      const Eigen::Vector3d low = index.cast<double>() * cell_m;
      cell.chunk.origin = low + Eigen::Vector3d::Constant(0.5 * cell_m);
      cell.lamps = lamps_reaching({low, low + Eigen::Vector3d::Constant(cell_m)});
    }
    return cell;
  }

  std::vector<int> lamps_reaching(const Eigen::AlignedBox3d& box) const {
    std::vector<int> reaching;
    for (std::size_t i = 0; i < world_.lamps().size(); ++i) {
      const Lamp& lamp = world_.lamps()[i];
      if (box.exteriorDistance(lamp.position) < lamp.reach_m) reaching.push_back(static_cast<int>(i));
    }
    return reaching;
  }

  void add_piece(const Polygon& piece, Cell& cell) {
    const std::vector<Eigen::Vector2f> light = light_map_.add(piece, face_.normal, cell.lamps);
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < piece.size(); ++i) corners.push_back(add_vertex(piece[i], light[i], cell.chunk));
    for (std::size_t i = 2; i < corners.size(); ++i) {
      cell.chunk.indices.insert(cell.chunk.indices.end(), {corners[0], corners[i - 1], corners[i]});
    }
  }

  std::uint32_t add_vertex(const Eigen::Vector3d& point, const Eigen::Vector2f& light, RenderChunk& chunk) const {
    // Whole tiles are taken away, the same ones all over the chunk, to keep float32 precise far from the origin.
    const Eigen::Vector4d whole_tiles = face_.mapping(chunk.origin).array().floor();
    RenderVertex vertex;
    Eigen::Map<Eigen::Vector3f>(vertex.position.data()) = (point - chunk.origin).cast<float>();
    Eigen::Map<Eigen::Vector4f>(vertex.place.data()) = (face_.mapping(point) - whole_tiles).cast<float>();
    Eigen::Map<Eigen::Vector2f>(vertex.light.data()) = light;
    vertex.surface = face_.surface;
    chunk.bounds.extend(point);
    chunk.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(chunk.vertices.size() - 1);
  }

  const World& world_;
  double large_cell_m_ = 4.0 * kCell_m;
  LightMapBuilder light_map_;
  Face face_;
  std::map<std::tuple<double, int, int, int>, Cell> cells_;
};

}  // namespace

RenderScene make_render_scene(const World& world, const std::vector<int>& layer_of_material, double view_distance_m) {
  const std::vector<int> geoms = drawn_geoms(world);
  const double extent_m = plane_extent(world, geoms, view_distance_m);
  ChunkBuilder builder(world, extent_m);
  for (const int geom : geoms) {
    const auto material = static_cast<std::size_t>(world.material_of(geom));
    const Eigen::Map<const Eigen::Vector3d> position(world.data().geom_xpos + 3 * geom);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(world.data().geom_xmat + 9 * geom);
    const SurfaceMapping mapping(world.model(), geom, world.seed());
    const TriangleMesh mesh = mesh_of_geom(world.model(), geom, kCurveTolerance_m, extent_m);
    for (const auto& corners : mesh.triangles) {
      Polygon triangle;
      for (const std::uint32_t corner : corners) {
        triangle.emplace_back(rotation * mesh.vertices[corner].cast<double>() + position);
      }
      builder.add_triangle(triangle, mapping, layer_of_material[material], world.materials()[material]);
    }
  }
  return builder.take();
}

}  // namespace plumbline
