#include "tools/mount/mount_study.h"

#include <algorithm>
#include <set>

#include "scenarios/scenario.h"
#include "scenarios/yaml_reader.h"

namespace plumbline {
namespace {

constexpr Range kShare{0.0, 1.0};
constexpr Range kWeight{0.0, 1000.0};
constexpr Range kMountings{1, 10'000};

std::vector<std::string> mount_keys() {
  std::vector<std::string> keys;
  for (const char* part : {"rig.", "rig.lidar.", "rig.camera."}) {
    for (const char* key : {"x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"}) {
      keys.push_back(std::string(part) + key);
    }
  }
  return keys;
}

void read_scenarios(ConfigReader& reader, MountStudy& study) {
  const ConfigNode* node = reader.find("scenarios");
  if (node == nullptr) fail_at(reader.node(), "scenarios", "a list of scenario files");
  std::set<std::string> names;
  for (const ConfigNode& item : list_of(*node, "scenarios")) {
    const std::filesystem::path file = item.directory / text_of(item, "scenarios");
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) fail_at(item, "scenarios", "an existing file");
    if (!names.insert(file.stem().string()).second) fail_at(item, "scenarios", "each scenario once");
    study.scenarios.push_back(file);
  }
  if (study.scenarios.empty()) fail_at(*node, "scenarios", "at least one scenario");
}

void check_axes(const ConfigNode& file, const SweepFile& runs) {
  const std::vector<std::string> known = mount_keys();
  if (runs.axes.empty()) fail_at(file, "mount", "at least one free angle or offset");
  for (const SweepAxis& axis : runs.axes) {
    const ConfigNode& node = file.entries.at("mount").entries.at(axis.key);
    if (std::find(known.begin(), known.end(), axis.key) == known.end()) {
      fail_at(node, "mount." + axis.key, "a part's angle or offset, such as " + nearest(axis.key, known));
    }
    if (!axis.is_numeric()) fail_at(node, "mount." + axis.key, "numbers");
  }
}

void read_weights(ConfigReader& reader, MountWeights& weights) {
  reader.read("drift", weights.drift, kWeight);
  reader.read("worst_direction", weights.worst_direction, kWeight);
  reader.read("coverage", weights.coverage, kWeight);
  reader.read("degenerate_time", weights.degenerate_time, kWeight);
  if (weights.drift + weights.worst_direction + weights.coverage + weights.degenerate_time <= 0.0) {
    fail_at(reader.node(), reader.path(), "at least one weight above 0");
  }
}

void read_trial(ConfigReader& reader, MountTrial& trial) {
  reader.read("mountings", trial.mountings, kMountings);
  std::size_t choice = 0;
  if (reader.read_choice("choose", {"best", "spread"}, choice)) trial.spread = choice == 1;
}

void read_surfaces(ConfigReader& reader, MountStudy& study) {
  const ConfigNode* node = reader.find("surfaces");
  if (node == nullptr) return;
  for (const ConfigNode& item : list_of(*node, "surfaces")) study.surfaces.push_back(text_of(item, "surfaces"));
}

std::string judged_estimator(const MountStudy& study) {
  const std::string own = load_scenario(study.scenarios.front(), {}, {}).estimator_name;
  const std::vector<std::string>& listed = study.runs.estimators;
  return listed.empty() || std::find(listed.begin(), listed.end(), own) != listed.end() ? own : listed.front();
}

}  // namespace

MountStudy read_mount_study(const std::filesystem::path& path) {
  const ConfigNode file = read_yaml_file(path);
  MountStudy study;
  study.name = study.runs.name = path.stem().string();
  study.path = study.runs.path = path;
  ConfigReader reader(file, "");
  read_scenarios(reader, study);
  read_runs(reader, study.runs, "mount");
  check_axes(file, study.runs);
  std::string vehicle;
  if (reader.read("vehicle", vehicle)) study.runs.fixed.push_back("motion.vehicle=" + vehicle);
  read_limits(reader, study.runs.limits, [&](ConfigReader& limits) {
    limits.read("own_body_share", study.limits.own_body_share, kShare);
    limits.read("overlap", study.limits.overlap, kShare);
  });
  reader.section("weigh", [&](ConfigReader& weights) { read_weights(weights, study.weights); });
  reader.section("trial", [&](ConfigReader& trial) { read_trial(trial, study.trial); });
  read_surfaces(reader, study);
  reader.finish();
  study.judged = judged_estimator(study);
  return study;
}

}  // namespace plumbline
