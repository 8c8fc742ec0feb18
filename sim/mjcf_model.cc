#include "sim/mjcf_model.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 64U << 20U;

// Our own names inside MuJoCo's virtual file system, which compares names without their folders: a user's file of the
// same name would be hidden, so they are unlikely ones.
constexpr char kWrapperName[] = "plumbline-wrapper-7c1f.xml";
constexpr char kSceneName[] = "plumbline-scene-7c1f.xml";
constexpr char kMeshExtension[] = ".msh";

/// MuJoCo's messages run over several lines; ours are one.
std::string on_one_line(std::string_view message) {
  std::string line;
  for (const char c : message) {
    if (c != '\n') {
      line += c;
    } else if (!line.empty() && !line.ends_with("; ")) {
      line += "; ";
    }
  }
  while (line.ends_with("; ")) line.resize(line.size() - 2);
  return line;
}

[[noreturn]] void throw_mujoco_error(const char* message) { throw std::invalid_argument(message); }
void ignore_mujoco_warning(const char*) {}

// MuJoCo's own handlers write MUJOCO_LOG.TXT into the working folder, and end the process on an error.
void install_mujoco_handlers() {
  static std::once_flag once;
  std::call_once(once, [] {
    mju_user_error = throw_mujoco_error;
    mju_user_warning = ignore_mujoco_warning;
  });
}

std::string escape_attribute(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

// Geoms that nothing collides with spare MuJoCo their convex hulls.
std::string mesh_geoms(std::size_t mesh_count) {
  std::string geoms;
  for (std::size_t i = 0; i < mesh_count; ++i) {
    geoms += "    <geom name=\"" + mesh_geom_name(i) + "\" type=\"mesh\" mesh=\"" + mesh_geom_name(i) +
             "\" contype=\"0\" conaffinity=\"0\" rgba=\"1 1 1 1\"/>\n";
  }
  return geoms;
}

// MuJoCo names a mesh after its file.
std::string mesh_assets(std::size_t mesh_count) {
  std::string assets;
  for (std::size_t i = 0; i < mesh_count; ++i) {
    assets += "    <mesh file=\"" + mesh_geom_name(i) + kMeshExtension + "\" scale=\"1 1 1\"/>\n";
  }
  return assets;
}

// Includes the scene untouched, whatever it holds, and adds the meshes and the rig body to its world.
std::string wrapper_mjcf(std::string_view included_file, std::size_t mesh_count) {
  return "<mujoco>\n  <include file=\"" + escape_attribute(included_file) + "\"/>\n  <asset>\n" +
         mesh_assets(mesh_count) + "  </asset>\n  <worldbody>\n" + mesh_geoms(mesh_count) + "    <body name=\"" +
         kRigBodyName + "\" mocap=\"true\"/>\n  </worldbody>\n</mujoco>\n";
}

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

// MuJoCo's own format: counts of vertices, normals, texture coordinates and faces, and then these. Upright normals are
// sent along because MuJoCo would take its time to find better ones.
std::string msh_file(const SceneMesh& mesh) {
  constexpr std::size_t kLeastVertices = 4;
  std::vector<Eigen::Vector3f> vertices = mesh.vertices;
  while (vertices.size() < kLeastVertices) vertices.push_back(vertices.back());
  const std::vector<Eigen::Vector3f> normals(vertices.size(), Eigen::Vector3f::UnitZ());
  const auto count = static_cast<std::int32_t>(vertices.size());
  const std::vector<std::int32_t> counts{count, count, 0, static_cast<std::int32_t>(mesh.triangles.size())};
  std::string file;
  for (const auto bytes : {bytes_of(counts), bytes_of(vertices), bytes_of(normals), bytes_of(mesh.triangles)}) {
    file.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  return file;
}

void restore_vertices(mjModel& model, const SceneMesh& mesh, int geom) {
  const int id = model.geom_dataid[geom];
  float* vertex = model.mesh_vert + 3L * model.mesh_vertadr[id];
  std::fill_n(vertex, 3L * model.mesh_vertnum[id], 0.0F);
  double radius = 0.0;
  Eigen::Vector3d half_size = Eigen::Vector3d::Zero();  // of the box about the origin in which mj_ray looks
  for (const Eigen::Vector3f& given : mesh.vertices) {
    vertex = std::copy_n(given.data(), 3, vertex);
    radius = std::max(radius, given.cast<double>().norm());
    half_size = half_size.cwiseMax(given.cast<double>().cwiseAbs());
  }
  const mjtNum unturned[4] = {1, 0, 0, 0};
  std::copy_n(mesh.origin.data(), 3, model.geom_pos + 3L * geom);
  std::copy_n(unturned, 4, model.geom_quat + 4L * geom);
  std::copy_n(half_size.data(), 3, model.geom_size + 3L * geom);
  model.geom_sameframe[geom] = 0;  // MuJoCo skips the pose of a geom that stands as its body does
  model.geom_rbound[geom] = radius;
}

class VirtualFiles {
 public:
  VirtualFiles() : vfs_(std::make_unique<mjVFS>()) { mj_defaultVFS(vfs_.get()); }
  VirtualFiles(const VirtualFiles&) = delete;
  VirtualFiles& operator=(const VirtualFiles&) = delete;
  ~VirtualFiles() { mj_deleteVFS(vfs_.get()); }

  void add(const char* name, std::string_view content) {
    const int size = static_cast<int>(content.size());
    if (mj_makeEmptyFileVFS(vfs_.get(), name, size) != 0) throw std::invalid_argument("MJCF is empty or too large");
    const int index = mj_findFileVFS(vfs_.get(), name);
    std::memcpy(vfs_->filedata[index], content.data(), content.size());
  }
  const mjVFS* get() const { return vfs_.get(); }

 private:
  std::unique_ptr<mjVFS> vfs_;  // 2 MB, too much for a stack
};

// MuJoCo only warns of "nan" in a file, and a NaN in the world would poison everything that is cast at or drawn.
void check_finite(const mjModel& model) {
  const auto all_finite = [](const auto* values, int count) {
    return std::all_of(values, values + count, [](auto value) { return std::isfinite(value); });
  };
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!all_finite(model.geom_size + 3 * geom, 3) || !all_finite(model.geom_pos + 3 * geom, 3) ||
        !all_finite(model.geom_quat + 4 * geom, 4)) {
      const char* name = mj_id2name(&model, mjOBJ_GEOM, geom);
      throw std::invalid_argument("geom " + std::to_string(geom) + " '" + (name ? name : "") +
                                  "' has a size or pose that is not finite");
    }
  }
  if (!all_finite(model.mesh_vert, 3 * model.nmeshvert))
    throw std::invalid_argument("a mesh has a vertex that is not finite");
  if (!all_finite(model.hfield_data, model.nhfielddata) || !all_finite(model.hfield_size, 4 * model.nhfield)) {
    throw std::invalid_argument("a height field is not finite");
  }
  if (!all_finite(model.body_pos, 3 * model.nbody) || !all_finite(model.body_quat, 4 * model.nbody)) {
    throw std::invalid_argument("a body has a pose that is not finite");
  }
}

// `path` names the wrapper; its folder is where MuJoCo looks for included files, meshes and textures.
MjModelPtr load(const std::string& path, const VirtualFiles& files) {
  std::array<char, 1024> message{};
  MjModelPtr model(mj_loadXML(path.c_str(), files.get(), message.data(), static_cast<int>(message.size())));
  if (!model) throw std::invalid_argument(on_one_line(message.data()));
  check_finite(*model);
  model->opt.disableflags |= mjDSBL_CONTACT;
  return model;
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::string> attribute_values(std::string_view text, const std::string& attribute) {
  const std::string opening = attribute + "=\"";
  std::vector<std::string> values;
  for (auto at = text.find(opening); at != std::string_view::npos; at = text.find(opening, at)) {
    at += opening.size();
    values.emplace_back(text.substr(at, text.find('"', at) - at));
  }
  return values;
}

// MuJoCo's message about a texture that cannot be opened does not say which file it looked for. Only an error message
// rests on this, so that looking at the text, and not at the parsed XML, is good enough.
std::string missing_files(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  std::vector<std::filesystem::path> folders{path.parent_path()};
  for (const char* attribute : {"meshdir", "texturedir"}) {
    for (const std::string& folder : attribute_values(text, attribute)) folders.push_back(path.parent_path() / folder);
  }
  std::string missing;
  for (const std::string& file : attribute_values(text, "file")) {
    std::error_code error;
    const bool found = std::any_of(folders.begin(), folders.end(),
                                   [&](const auto& folder) { return std::filesystem::exists(folder / file, error); });
    if (!found) missing += (missing.empty() ? " (missing files: " : ", ") + file;
  }
  return missing.empty() ? missing : missing + ")";
}

void check_readable(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw std::invalid_argument("no such file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw std::invalid_argument(error.message());
  if (size == 0) throw std::invalid_argument("the file is empty");
  if (size > kMaxFileBytes) {
    throw std::invalid_argument(std::to_string(size) + " bytes, at most " + std::to_string(kMaxFileBytes) +
                                " are allowed");
  }
}

}  // namespace

void MjModelDeleter::operator()(mjModel_* model) const { mj_deleteModel(model); }
void MjDataDeleter::operator()(mjData_* data) const { mj_deleteData(data); }

std::string mesh_geom_name(std::size_t mesh) { return "plumbline_mesh_" + std::to_string(mesh); }

MjModelPtr compile_mjcf(const std::string& mjcf, const std::vector<SceneMesh>& meshes) {
  install_mujoco_handlers();
  VirtualFiles files;
  files.add(kSceneName, mjcf);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    files.add((mesh_geom_name(i) + kMeshExtension).c_str(), msh_file(meshes[i]));
  }
  files.add(kWrapperName, wrapper_mjcf(kSceneName, meshes.size()));
  MjModelPtr model = load(kWrapperName, files);
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    restore_vertices(*model, meshes[i], mj_name2id(model.get(), mjOBJ_GEOM, mesh_geom_name(i).c_str()));
  }
  return model;
}

MjModelPtr compile_mjcf_file(const std::filesystem::path& path) {
  install_mujoco_handlers();
  try {
    check_readable(path);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path.string() + ": " + error.what());
  }
  try {
    VirtualFiles files;
    files.add(kWrapperName, wrapper_mjcf(path.filename().string(), 0));
    return load((std::filesystem::absolute(path).parent_path() / kWrapperName).string(), files);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path.string() + ": " + error.what() + missing_files(path));
  }
}

MjDataPtr forward_initial_state(const mjModel_& model) {
  install_mujoco_handlers();
  MjDataPtr data(mj_makeData(&model));
  if (!data) throw std::invalid_argument("MuJoCo could not allocate the model's data");
  mj_forward(&model, data.get());
  return data;
}

}  // namespace plumbline
