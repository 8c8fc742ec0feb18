#pragma once

#include <filesystem>
#include <memory>
#include <string>

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

/// Compiles MJCF text and adds the rig body. Contacts are off: nothing in a proving ground is pushed about.
/// @throws std::invalid_argument with MuJoCo's message.
MjModelPtr compile_mjcf(const std::string& mjcf);

/// The same from a file; meshes, textures and includes resolve relative to it. Nothing is written, beside it or
/// elsewhere.
/// @throws std::invalid_argument naming the file if it is missing, over 64 MB, or rejected by MuJoCo.
MjModelPtr compile_mjcf_file(const std::filesystem::path& path);

/// The state after mj_forward at the initial pose. @throws std::invalid_argument with MuJoCo's message.
MjDataPtr forward_initial_state(const mjModel_& model);

}  // namespace plumbline
