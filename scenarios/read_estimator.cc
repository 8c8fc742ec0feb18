#include <algorithm>

#include "scenarios/figures.h"
#include "scenarios/input_error.h"
#include "scenarios/schema.h"

namespace plumbline {
namespace {

constexpr Range kFigure{-1e12, 1e12};

void read_enabled(ConfigReader& reader, const std::string& key, bool& enabled) {
  reader.section(key, [&](ConfigReader& module) { module.read("enabled", enabled); });
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

void read_estimator(ConfigReader& reader, std::string& name, EstimatorConfig& config) {
  std::vector<std::string> names;
  for (const auto& info : estimator_library()) names.push_back(info.name);
  std::size_t index = 0;
  if (reader.read_choice("name", names, index)) name = names[index];
  read_enabled(reader, "imu", config.imu_enabled);
  read_enabled(reader, "vision", config.vision_enabled);
  read_enabled(reader, "lidar", config.lidar_enabled);
  reader.section("degeneracy", [&](ConfigReader& degeneracy) { degeneracy.read("remapping", config.remapping); });
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
