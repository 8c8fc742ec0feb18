#include "sim/scenes/mjcf_writer.h"

#include <charconv>
#include <initializer_list>
#include <stdexcept>
#include <utility>

namespace plumbline {
namespace {

// Ten micrometres: far below any sensor's noise, and short enough to read.
std::string number(double value) {
  char text[64];
  const auto result = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 5);
  return {text, result.ptr};
}

std::string attribute(const char* name, std::initializer_list<double> values) {
  std::string text = std::string(" ") + name + "=\"";
  bool first = true;
  for (const double value : values) {
    if (!first) text += ' ';
    first = false;
    text += number(value);
  }
  return text + '"';
}

std::string attribute(const char* name, const Eigen::Vector3d& v) { return attribute(name, {v.x(), v.y(), v.z()}); }

std::string orientation(const Eigen::Quaterniond& q) {
  if (q.isApprox(Eigen::Quaterniond::Identity(), 1e-12)) return {};
  return attribute("quat", {q.w(), q.x(), q.y(), q.z()});
}

}  // namespace

void MjcfWriter::begin_geom(const char* type, const std::string& material) {
  used_materials_.insert(material);
  geoms_ += std::string("    <geom type=\"") + type + "\" material=\"" + material + '"';
}

void MjcfWriter::mesh(SceneMesh mesh) {
  used_materials_.insert(mesh.material);
  meshes_.push_back(std::move(mesh));
}

void MjcfWriter::begin_body(const std::string& name) { geoms_ += "    <body name=\"" + name + "\" mocap=\"true\">\n"; }

void MjcfWriter::end_body() { geoms_ += "    </body>\n"; }

void MjcfWriter::box(const std::string& material, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     const Pose& world_from_local) {
  begin_geom("box", material);
  geoms_ += attribute("size", (high - low) / 2.0) + attribute("pos", world_from_local * ((low + high) / 2.0)) +
            orientation(world_from_local.rotation) + "/>\n";
}

void MjcfWriter::ellipsoid(const std::string& material, const Eigen::Vector3d& centre, const Eigen::Vector3d& semi_axes,
                           const Pose& world_from_local) {
  begin_geom("ellipsoid", material);
  geoms_ += attribute("size", semi_axes) + attribute("pos", world_from_local * centre) +
            orientation(world_from_local.rotation) + "/>\n";
}

void MjcfWriter::cylinder(const std::string& material, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                          double radius_m, const Pose& world_from_local) {
  rod("cylinder", material, from, to, radius_m, world_from_local);
}

void MjcfWriter::capsule(const std::string& material, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                         double radius_m, const Pose& world_from_local) {
  rod("capsule", material, from, to, radius_m, world_from_local);
}

void MjcfWriter::rod(const char* type, const std::string& material, const Eigen::Vector3d& from,
                     const Eigen::Vector3d& to, double radius_m, const Pose& world_from_local) {
  const Eigen::Vector3d a = world_from_local * from;
  const Eigen::Vector3d b = world_from_local * to;
  begin_geom(type, material);
  geoms_ += attribute("size", {radius_m}) + attribute("fromto", {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}) + "/>\n";
}

SceneDescription MjcfWriter::finish(const std::string& model_name, const std::vector<Material>& palette,
                                    double ambient_lux, double sky_luminance) {
  SceneDescription scene;
  std::string assets;
  for (const Material& material : palette) {
    if (!used_materials_.contains(material.name)) continue;
    scene.materials.push_back(material);
    assets += "    <material name=\"" + material.name + "\"" +
              attribute("rgba", {material.albedo, material.albedo, material.albedo, 1.0}) + "/>\n";
  }
  if (scene.materials.size() != used_materials_.size()) {
    throw std::logic_error("scene " + model_name + " uses a material that is not in its palette");
  }
  scene.mjcf = "<mujoco model=\"" + model_name + "\">\n" +
               "  <default><geom contype=\"0\" conaffinity=\"0\"/></default>\n"  // scenery never moves
               "  <asset>\n" +
               assets + "  </asset>\n  <worldbody>\n" + geoms_ + "  </worldbody>\n</mujoco>\n";
  scene.lamps = lamps_;
  scene.meshes = std::move(meshes_);
  scene.ambient_lux = ambient_lux;
  scene.sky_luminance = sky_luminance;
  return scene;
}

Pose upright_frame(const Eigen::Vector3d& origin_in_world, double yaw) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())), origin_in_world};
}

}  // namespace plumbline
