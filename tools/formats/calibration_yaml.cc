#include "tools/formats/calibration_yaml.h"

#include <cmath>
#include <vector>

#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"
#include "scenarios/yaml_reader.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

constexpr Range kDensity{0.0, 1e3};
constexpr Range kRate_hz{1e-2, 1e5};
constexpr Range kMetres{-1e4, 1e4};
constexpr Range kPixels{-1e6, 1e6};
constexpr Range kRange_m{0.0, 1e5};
constexpr Range kPositive{1e-6, 1e6};
constexpr Range kImageSide{1.0, 16'384.0};
constexpr Range kMostCameraId{0.0, 1e6};
constexpr Range kRings{1.0, 65'536.0};
constexpr Range kUnit{-1.001, 1.001};
constexpr Range kHalfSize{1e-6, 1e2};
constexpr std::size_t kMostListed = 64;

/// Writes fields as YAML in block style.
class Writer {
 public:
  void number(const char* key, double value, Range) { append_exact(line(key), value); }
  void whole(const char* key, int value, Range) { line(key) += std::to_string(value); }
  void numbers(const char* key, const std::vector<double*>& values, Range) {
    std::string& text = line(key) += '[';
    for (const double* value : values) {
      if (value != values.front()) text += ", ";
      append_exact(text, *value);
    }
    text += ']';
  }
  template <typename Fields>
  void section(const char* key, Fields fields) {
    line(key).pop_back();  // a space that nothing follows
    ++depth_;
    fields(*this);
    --depth_;
  }
  template <typename Item, typename Fields>
  void list(const char* key, std::vector<Item>& items, Fields fields) {
    if (items.empty()) return;
    line(key).pop_back();
    for (Item& item : items) {
      begin_item_ = true;
      depth_ += 2;
      fields(*this, item);
      depth_ -= 2;
    }
  }
  std::string text() && { return std::move(text_).append("\n").substr(1); }

 private:
  std::string& line(const char* key) {
    text_ += '\n' + std::string(2 * depth_, ' ');
    if (begin_item_) text_.replace(text_.size() - 2, 2, "- ");
    begin_item_ = false;
    return text_ += std::string(key) + ": ";
  }

  std::string text_;
  std::size_t depth_ = 0;
  bool begin_item_ = false;
};

/// Reads the same fields; every one must be there.
class Reader {
 public:
  explicit Reader(ConfigReader& keys) : keys_(keys) {}

  void number(const char* key, double& value, Range range) {
    if (!keys_.read(key, value, range)) fail_missing(key);
  }
  void whole(const char* key, int& value, Range range) {
    if (!keys_.read(key, value, range)) fail_missing(key);
  }
  void numbers(const char* key, const std::vector<double*>& values, Range range) {
    std::vector<double> found;
    if (!keys_.read(key, found, range)) fail_missing(key);
    if (found.size() != values.size()) {
      fail_at(*keys_.find(key), keys_.path_of(key), std::to_string(values.size()) + " numbers");
    }
    for (std::size_t i = 0; i < values.size(); ++i) *values[i] = found[i];
  }
  template <typename Fields>
  void section(const char* key, Fields fields) {
    if (!keys_.section(key, [&](ConfigReader& below) { read_below(below, fields); })) fail_missing(key);
  }
  template <typename Item, typename Fields>
  void list(const char* key, std::vector<Item>& items, Fields fields) {
    const ConfigNode* node = keys_.find(key);
    if (node == nullptr) return;
    const std::string path = keys_.path_of(key);
    if (list_of(*node, path).size() > kMostListed) {
      fail_at(*node, path, "at most " + std::to_string(kMostListed));
    }
    for (const ConfigNode& item : node->items) {
      ConfigReader below(item, path);
      read_below(below, [&](Reader& reader) { fields(reader, items.emplace_back()); });
      below.finish();
    }
  }

 private:
  template <typename Fields>
  static void read_below(ConfigReader& below, Fields fields) {
    Reader reader(below);
    fields(reader);
  }
  [[noreturn]] void fail_missing(const char* key) const {
    throw InputError(keys_.node().where + ": " + keys_.path_of(key) +
                     ": missing; every key of a section must be there");
  }

  ConfigReader& keys_;
};

// The format itself: each function names the fields of one section, to be written or read.

template <typename Format>
void pose_fields(Format& format, const char* key, Pose& pose) {
  format.section(key, [&](Format& below) {
    Eigen::Vector3d& t = pose.translation;
    Eigen::Vector4d& q = pose.rotation.coeffs();
    below.numbers("translation_m", {&t.x(), &t.y(), &t.z()}, kMetres);
    below.numbers("quaternion_xyzw", {&q.x(), &q.y(), &q.z(), &q.w()}, kUnit);
  });
}

template <typename Format>
void imu_fields(Format& format, Calibration& calibration) {
  ImuNoise& noise = calibration.imu;
  format.number("rate_hz", calibration.imu_rate_hz, kRate_hz);
  format.number("gyro_density_rad_per_s_sqrt_hz", noise.gyro_density, kDensity);
  format.number("accel_density_mps2_per_sqrt_hz", noise.accel_density, kDensity);
  format.number("gyro_random_walk_rad_per_s2_sqrt_hz", noise.gyro_random_walk, kDensity);
  format.number("accel_random_walk_mps3_per_sqrt_hz", noise.accel_random_walk, kDensity);
  format.number("gyro_turn_on_sigma_rad_per_s", noise.gyro_turn_on_sigma, kDensity);
  format.number("accel_turn_on_sigma_mps2", noise.accel_turn_on_sigma, kDensity);
  format.number("gyro_bias_instability_rad_per_s", noise.gyro_bias_instability, kDensity);
  format.number("accel_bias_instability_mps2", noise.accel_bias_instability, kDensity);
}

template <typename Format>
void view_fields(Format& format, double& rate_hz, Pose& body_from_camera, CameraIntrinsics& camera) {
  LensDistortion& lens = camera.distortion;
  format.number("rate_hz", rate_hz, kRate_hz);
  pose_fields(format, "body_from_camera", body_from_camera);
  format.whole("width_px", camera.width, kImageSide);
  format.whole("height_px", camera.height, kImageSide);
  format.number("fx_px", camera.fx, kPositive);
  format.number("fy_px", camera.fy, kPositive);
  format.number("cx_px", camera.cx, kPixels);
  format.number("cy_px", camera.cy, kPixels);
  format.numbers("distortion", {&lens.k1, &lens.k2, &lens.p1, &lens.p2}, {-1e3, 1e3});
}

template <typename Format>
void camera_fields(Format& format, Calibration& calibration) {
  view_fields(format, calibration.camera_rate_hz, calibration.body_from_camera, calibration.camera);
  format.number("electrons_per_dn", calibration.camera_noise.electrons_per_dn, kPositive);
  format.number("read_noise_dn", calibration.camera_noise.read_noise_dn, {0.0, 255.0});
}

template <typename Format>
void lidar_fields(Format& format, Calibration& calibration) {
  format.number("rate_hz", calibration.lidar_rate_hz, kRate_hz);
  pose_fields(format, "body_from_lidar", calibration.body_from_lidar);
  format.whole("rings", calibration.lidar_rings, kRings);
  format.number("range_sigma_m", calibration.lidar_range_sigma_m, kRange_m);
  format.number("min_range_m", calibration.lidar_min_range_m, kRange_m);
  format.number("max_range_m", calibration.lidar_max_range_m, kRange_m);
}

template <typename Format>
void fields(Format& format, Calibration& calibration) {
  format.section("imu", [&](Format& below) { imu_fields(below, calibration); });
  if (calibration.has_camera) {
    format.section("camera", [&](Format& below) { camera_fields(below, calibration); });
  }
  format.list("further_cameras", calibration.further_cameras, [](Format& below, FurtherCamera& camera) {
    below.whole("camera_id", camera.camera_id, kMostCameraId);
    view_fields(below, camera.rate_hz, camera.body_from_camera, camera.intrinsics);
  });
  if (calibration.has_lidar) {
    format.section("lidar", [&](Format& below) { lidar_fields(below, calibration); });
  }
  format.list("own_body", calibration.own_body, [](Format& below, OwnPart& part) {
    pose_fields(below, "body_from_part", part.body_from_part);
    Eigen::Vector3d& half = part.half_size_m;
    below.numbers("half_size_m", {&half.x(), &half.y(), &half.z()}, kHalfSize);
  });
}

/// A rotation typed in with few digits is brought to unit length; one that is as near as rounding allows is left alone.
void make_unit(Eigen::Quaterniond& rotation, const std::string& where) {
  const double excess = std::abs(rotation.norm() - 1.0);
  if (!(excess < 1e-3)) throw InputError(where + ": found a quaternion_xyzw that is not of unit length");
  if (excess > 1e-12) rotation.normalize();
}

}  // namespace

std::string calibration_yaml(const Calibration& calibration) {
  Calibration written = calibration;
  Writer writer;
  writer.whole("calibration_version", kCalibrationVersion, {});
  fields(writer, written);
  return std::move(writer).text();
}

Calibration read_calibration_yaml(const std::string& text, const std::string& origin) {
  const ConfigNode node = read_yaml_text(text, origin, {});
  ConfigReader keys(node, "");
  Calibration calibration;
  int version = 0;
  if (!keys.read("calibration_version", version, {0, 1e9})) throw InputError(origin + ": no calibration_version");
  if (version != kCalibrationVersion) {
    throw InputError(origin + ": calibration_version: found " + std::to_string(version) + ", this program reads " +
                     std::to_string(kCalibrationVersion));
  }
  calibration.has_camera = keys.find("camera") != nullptr;
  calibration.has_lidar = keys.find("lidar") != nullptr;
  Reader reader(keys);
  fields(reader, calibration);
  keys.finish();
  make_unit(calibration.body_from_camera.rotation, origin + ": camera.body_from_camera");
  make_unit(calibration.body_from_lidar.rotation, origin + ": lidar.body_from_lidar");
  for (FurtherCamera& camera : calibration.further_cameras) {
    make_unit(camera.body_from_camera.rotation, origin + ": further_cameras.body_from_camera");
  }
  for (OwnPart& part : calibration.own_body) {
    make_unit(part.body_from_part.rotation, origin + ": own_body.body_from_part");
  }
  return calibration;
}

}  // namespace plumbline
