#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/scene_mesh.h"

struct mjModel_;
struct mjData_;

namespace plumbline {

struct MjModelDeleter {
  void operator()(mjModel_* model) const;
};
struct MjDataDeleter {
  void operator()(mjData_* data) const;
};
using MjModelPtr = std::unique_ptr<mjModel_, MjModelDeleter>;
using MjDataPtr = std::unique_ptr<mjData_, MjDataDeleter>;

/// The mocap body that carries the sensors; every compiled model has it, as a child of the world and without geoms.
inline constexpr char kRigBodyName[] = "plumbline_rig";

/// MuJoCo's virtual file system holds 2000 files; the MJCF and its wrapper are two of them.
inline constexpr std::size_t kMaxMeshes = 1900;

/// Compiles MJCF text and adds the rig body. Contacts are off: nothing in a proving ground is pushed about.
/// Mesh i becomes a geom of the world's named mesh_geom_name(i), without a material, its vertices in the compiled model
/// those handed over. (MuJoCo turns meshes about their principal axes, which rounds each of two neighbours differently
/// and opens cracks between them; that is undone.)
/// @param meshes  at most kMaxMeshes, as check_meshes() wants them
/// @throws std::invalid_argument with MuJoCo's message.
MjModelPtr compile_mjcf(const std::string& mjcf, const std::vector<SceneMesh>& meshes = {});

std::string mesh_geom_name(std::size_t mesh);

/// The same from a file; meshes, textures and includes resolve relative to it. Nothing is written, beside it or
/// elsewhere.
/// @throws std::invalid_argument naming the file if it is missing, over 64 MB, or rejected by MuJoCo.
MjModelPtr compile_mjcf_file(const std::filesystem::path& path);

/// The state after mj_forward at the initial pose. @throws std::invalid_argument with MuJoCo's message.
MjDataPtr forward_initial_state(const mjModel_& model);

}  // namespace plumbline
