#include <algorithm>

#include "scenarios/figures.h"
#include "scenarios/input_error.h"
#include "scenarios/outside_name.h"
#include "scenarios/schema.h"

namespace plumbline {
namespace {

constexpr Range kFigure{-1e12, 1e12};
constexpr Range kFeatureShare{0.01, 1.0};
constexpr Range kResolutionFactor{1.0, 20.0};

std::string read_name(const ConfigNode& node, const std::string& key) {
  const std::string& name = text_of(node, key);
  if (const auto outside = outside_name(name)) {
    if (outside->words.empty()) fail_at(node, key, "a program after exec:");
    const auto file = outside->file();
    std::error_code error;
    if (file && !std::filesystem::is_regular_file(node.directory / *file, error)) {
      fail_at(node, key, "an existing file (looked for " + (node.directory / *file).string() + ")");
    }
    return name;
  }
  std::vector<std::string> names;
  for (const EstimatorInfo& info : estimator_library()) names.push_back(info.name);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    fail_at(node, key, "one of: " + joined(names) + ", exec:PROGRAM, LIBRARY.so");
  }
  return name;
}

Expectation read_bounds(ConfigReader& reader, const std::string& figure) {
  Expectation expectation{figure, std::nullopt, std::nullopt};
  double bound = 0.0;
  if (reader.read("min", bound, kFigure)) expectation.min = bound;
  if (reader.read("max", bound, kFigure)) expectation.max = bound;
  if (!expectation.min && !expectation.max) {
    throw InputError(reader.node().where + ": expect." + figure + ": found no bound, expected min, max or both");
  }
  if (expectation.min && expectation.max && *expectation.min > *expectation.max) {
    throw InputError(reader.node().where + ": expect." + figure + ": found min above max");
  }
  return expectation;
}

}  // namespace

void read_estimator(ConfigReader& reader, std::string& name, std::filesystem::path& directory,
                    EstimatorConfig& config) {
  if (const ConfigNode* node = reader.find("name")) {
    name = read_name(*node, reader.path_of("name"));
    directory = node->directory;
  }
  reader.section("imu", [&](ConfigReader& imu) { imu.read("enabled", config.imu_enabled); });
  reader.section("vision", [&](ConfigReader& vision) {
    vision.read("enabled", config.vision_enabled);
    vision.read("feature_share", config.feature_share, kFeatureShare);
  });
  reader.section("lidar", [&](ConfigReader& lidar) {
    lidar.read("enabled", config.lidar_enabled);
    lidar.read("resolution_factor", config.resolution_factor, kResolutionFactor);
  });
  reader.section("degeneracy", [&](ConfigReader& degeneracy) { degeneracy.read("remapping", config.remapping); });
  if (outside_name(name) && config != EstimatorConfig{}) {
    throw InputError(reader.node().where + ": " + reader.path_of("name") + ": found '" + name +
                     "', which has no settings such as vision.enabled or degeneracy.remapping");
  }
}

void read_expect(ConfigReader& reader, std::vector<Expectation>& expect, std::optional<std::string>& status) {
  static const std::vector<std::string> kStatuses{"ok", "failed", "lost", "error"};
  std::size_t index = 0;
  if (reader.read_choice("status", kStatuses, index)) status = kStatuses[index];
  for (const auto& figure : result_figures()) {
    reader.section(figure, [&](ConfigReader& bounds) { expect.push_back(read_bounds(bounds, figure)); });
  }
}

}  // namespace plumbline
