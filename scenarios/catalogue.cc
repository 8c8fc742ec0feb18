#include "scenarios/catalogue.h"

#include <algorithm>
#include <filesystem>

#include "scenarios/catalogue_file.h"
#include "scenarios/input_error.h"
#include "scenarios/yaml_reader.h"

namespace plumbline {
namespace {

std::filesystem::path catalogue_directory() { return PLUMBLINE_CATALOGUE_DIR; }

/// Every device says what it is; what else there is to say depends on the kind.
CatalogueEntry read_header(ConfigReader& reader, const std::string& name) {
  CatalogueEntry entry{name, "", ""};
  const bool complete = reader.read("kind", entry.kind) && reader.read("summary", entry.summary);
  if (!complete) throw InputError(reader.node().where + ": a catalogue file needs kind and summary");
  return entry;
}

}  // namespace

void read_device(const std::string& name, const std::string& kind,
                 const std::function<void(ConfigReader&)>& read_keys) {
  const std::filesystem::path path = catalogue_directory() / (name + ".yaml");
  const ConfigNode file = read_yaml_file(path);
  ConfigReader reader(file, "");
  if (read_header(reader, name).kind != kind) throw InputError(path.string() + ": is not a " + kind);
  read_keys(reader);
  reader.finish();
}

void read_scaled(ConfigReader& reader, const std::string& key, double unit, double& value, Range range) {
  double in_unit = 0.0;
  if (reader.read(key, in_unit, range)) value = in_unit * unit;
}

void read_scaled(ConfigReader& reader, const std::string& key, double unit, std::vector<double>& values, Range range) {
  if (!reader.read(key, values, range)) return;
  for (double& value : values) value *= unit;
}

std::vector<CatalogueEntry> sensor_catalogue() {
  std::vector<CatalogueEntry> entries;
  for (const auto& file : std::filesystem::directory_iterator(catalogue_directory())) {
    if (file.path().extension() != ".yaml") continue;
    const ConfigNode node = read_yaml_file(file.path());
    ConfigReader reader(node, "");
    entries.push_back(read_header(reader, file.path().stem().string()));
  }
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return entries;
}

std::vector<std::string> catalogue_names(const std::string& kind) {
  std::vector<std::string> names;
  for (const auto& entry : sensor_catalogue()) {
    if (entry.kind == kind) names.push_back(entry.name);
  }
  return names;
}

LidarModel catalogue_lidar(const std::string& name) {
  LidarModel model;
  model.name = name;
  read_device(name, "lidar", [&](ConfigReader& reader) {
    reader.read("elevation_deg", model.elevation_deg, {-90.0, 90.0});
    read_scaled(reader, "vertical_offset_mm", kMilli, model.vertical_offset_m, {-1000.0, 1000.0});
    read_scaled(reader, "laser_offset_us", kMicro, model.laser_offset_s, {0.0, 1000.0});
    read_scaled(reader, "cycle_us", kMicro, model.cycle_s, {1.0, 1000.0});
    reader.read("rate_hz", model.rate_hz, {1.0, 100.0});
    reader.read("min_range_m", model.min_range_m, {0.01, 10.0});
    reader.read("max_range_m", model.max_range_m, {1.0, 1000.0});
    reader.read("range_at_10_percent_m", model.range_at_10_percent_m, {1.0, 1000.0});
    reader.read("range_sigma_m", model.range_sigma_m, {0.0, 1.0});
    reader.read("range_resolution_m", model.range_resolution_m, {0.0, 1.0});
    reader.read("ring_bias_sigma_m", model.ring_bias_sigma_m, {0.0, 1.0});
  });
  return model;
}

CameraModel catalogue_camera(const std::string& name) {
  CameraModel model;
  model.name = name;
  read_device(name, "camera", [&](ConfigReader& reader) {
    reader.read("width", model.width, {16.0, 8192.0});
    reader.read("height", model.height, {16.0, 8192.0});
    reader.read("horizontal_fov_deg", model.horizontal_fov_deg, {1.0, 170.0});
    reader.read("rate_hz", model.rate_hz, {0.1, 1000.0});
    reader.read("electrons_per_dn", model.electrons_per_dn, {0.1, 1e4});
    reader.read("read_noise_electrons", model.read_noise_electrons, {0.0, 1e4});
    reader.read("full_well_electrons", model.full_well_electrons, {100.0, 1e7});
    reader.read("f_number", model.f_number, {0.5, 64.0});
    reader.read("electrons_per_lux_second", model.electrons_per_lux_second, {1.0, 1e8});
    reader.read("black_level_dn", model.black_level_dn, {0.0, 100.0});
    read_scaled(reader, "min_exposure_us", kMicro, model.min_exposure_s, {1.0, 1e6});
    read_scaled(reader, "max_exposure_ms", kMilli, model.max_exposure_s, {0.01, 1e4});
    reader.read("max_gain", model.max_gain, {1.0, 100.0});
    reader.read("target_dn", model.target_dn, {1.0, 254.0});
  });
  return model;
}

}  // namespace plumbline
