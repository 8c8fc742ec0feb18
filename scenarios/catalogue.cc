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

}  // namespace plumbline
