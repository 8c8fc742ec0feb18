#include "tools/thesis/experiment.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "scenarios/config_reader.h"
#include "scenarios/yaml_reader.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

constexpr Range kAnyNumber{-1e12, 1e12};
constexpr Range kLength_m{0.1, 1e6};
constexpr Range kSimulated_s{0.1, 1e6};
constexpr Range kSeedCount{3, 1000};
constexpr Range kSeed{0, 9e18};

std::string words_of(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

void require(const ConfigReader& reader, const std::string& key, bool there, const std::string& expected) {
  if (!there) fail_at(reader.node(), reader.path_of(key), expected);
}

std::vector<std::uint64_t> seeds_of(const ConfigNode& node, const std::string& key) {
  std::vector<std::uint64_t> seeds;
  if (!node.is_sequence()) {
    const auto count = static_cast<std::uint64_t>(integer_of(node, key, kSeedCount));
    for (std::uint64_t seed = 1; seed <= count; ++seed) seeds.push_back(seed);
    return seeds;
  }
  for (const ConfigNode& item : node.items) seeds.push_back(static_cast<std::uint64_t>(integer_of(item, key, kSeed)));
  const bool all_different = std::set<std::uint64_t>(seeds.begin(), seeds.end()).size() == seeds.size();
  if (seeds.size() < kSeedCount.min || !all_different) fail_at(node, key, "at least 3 seeds, each once");
  return seeds;
}

Configuration configuration_of(const ConfigNode& node, const std::string& key) {
  Configuration configuration;
  ConfigReader reader(node, key);
  require(reader, "name", reader.read("name", configuration.name), "what the page calls it");
  reader.read("estimator", configuration.estimator);
  if (const ConfigNode* set = reader.find("set")) {
    if (!set->is_map()) fail_at(*set, reader.path_of("set"), "a map of scenario keys and their values");
    for (const auto& [name, value] : set->entries) configuration.overrides.push_back(name + "=" + flow_yaml(value));
  }
  reader.finish();
  return configuration;
}

bool is_known(const Experiment& experiment, const std::string& configuration) {
  return std::any_of(experiment.configurations.begin(), experiment.configurations.end(),
                     [&](const Configuration& known) { return known.name == configuration; });
}

std::vector<std::string> names_of(const ConfigNode& node, const std::string& key, const Experiment& experiment) {
  std::vector<std::string> names;
  for (const ConfigNode& item : list_of(node, key)) {
    const std::string& name = text_of(item, key);
    if (!is_known(experiment, name)) fail_at(item, key, "the name of one of the row's configurations");
    names.push_back(name);
  }
  return names;
}

/// The kind of a check and the configurations that it is about.
void read_kind(ConfigReader& reader, const Experiment& experiment, ExperimentCheck& check) {
  struct Keyed {
    const char* key;
    ExperimentCheck::Kind kind;
  };
  static constexpr Keyed kLists[] = {{"order", ExperimentCheck::Kind::kOrder},
                                     {"rising", ExperimentCheck::Kind::kRising},
                                     {"ratio", ExperimentCheck::Kind::kRatio}};
  for (const auto& [key, kind] : kLists) {
    const ConfigNode* list = reader.find(key);
    if (list == nullptr) continue;
    if (!check.configurations.empty()) fail_at(*list, reader.path_of(key), "one of order, rising and ratio");
    check.kind = kind;
    check.configurations = names_of(*list, reader.path_of(key), experiment);
    const bool right_count =
        kind == ExperimentCheck::Kind::kRatio ? check.configurations.size() == 2 : check.configurations.size() >= 2;
    if (!right_count) fail_at(*list, reader.path_of(key), "two configurations (a ratio), or two and more");
  }
  const ConfigNode* of = reader.find("of");
  if (!check.configurations.empty()) {
    if (of != nullptr) fail_at(*of, reader.path_of("of"), "no `of` beside order, rising or ratio");
    return;
  }
  if (of != nullptr) {
    check.configurations = names_of(*of, reader.path_of("of"), experiment);
  } else {
    for (const Configuration& configuration : experiment.configurations) {
      check.configurations.push_back(configuration.name);
    }
  }
}

void read_limits(ConfigReader& reader, ExperimentCheck& check) {
  double bound = 0.0;
  if (reader.read("min", bound, kAnyNumber)) check.min = bound;
  if (reader.read("max", bound, kAnyNumber)) check.max = bound;
  if (reader.read("ok", bound, {0.0, 1.0})) {
    if (check.kind != ExperimentCheck::Kind::kBound || check.min || check.max) {
      fail_at(reader.node(), reader.path_of("ok"), "a share of runs, and no other check beside it");
    }
    check.kind = ExperimentCheck::Kind::kOk;
    check.figure = "status";
    check.min = bound;
  }
  const bool bounded = check.kind != ExperimentCheck::Kind::kOrder && check.kind != ExperimentCheck::Kind::kRising;
  if (bounded != (check.min || check.max)) {
    fail_at(reader.node(), reader.path(), bounded ? "min, max or both" : "neither min nor max beside an order");
  }
}

ExperimentCheck check_of(const ConfigNode& node, const std::string& key, const Experiment& experiment) {
  ExperimentCheck check;
  check.figure = experiment.figure;
  ConfigReader reader(node, key);
  reader.read("figure", check.figure);
  read_kind(reader, experiment, check);
  read_limits(reader, check);
  reader.finish();
  return check;
}

Experiment experiment_of(const ConfigNode& node, const std::string& key) {
  Experiment experiment;
  ConfigReader reader(node, key);
  require(reader, "id", reader.read("id", experiment.id), "a name of its own");
  require(reader, "claim", reader.read("claim", experiment.claim), "the claim in words");
  require(reader, "thesis", reader.read("thesis", experiment.thesis), "the thesis's figure");
  require(reader, "scenario", reader.read("scenario", experiment.scenario), "the scenario's file");
  require(reader, "figure", reader.read("figure", experiment.figure), "a key of result.json");
  require(reader, "simulated_s", reader.read("simulated_s", experiment.simulated_s, kSimulated_s), "seconds");
  double length_m = 0.0;
  if (reader.read("length_m", length_m, kLength_m)) experiment.length_m = length_m;
  const ConfigNode* seeds = reader.find("seeds");
  require(reader, "seeds", seeds != nullptr, "how many seeds, or which");
  experiment.seeds = seeds_of(*seeds, reader.path_of("seeds"));
  const ConfigNode* configurations = reader.find("configurations");
  require(reader, "configurations", configurations != nullptr, "a list of configurations");
  for (const ConfigNode& item : list_of(*configurations, reader.path_of("configurations"))) {
    Configuration configuration = configuration_of(item, reader.path_of("configurations"));
    if (is_known(experiment, configuration.name)) fail_at(item, reader.path_of("configurations"), "each name once");
    experiment.configurations.push_back(std::move(configuration));
  }
  const ConfigNode* checks = reader.find("checks");
  require(reader, "checks", checks != nullptr, "a list of checks");
  for (const ConfigNode& item : list_of(*checks, reader.path_of("checks"))) {
    experiment.checks.push_back(check_of(item, reader.path_of("checks"), experiment));
  }
  reader.finish();
  if (experiment.configurations.empty()) fail_at(*configurations, reader.path_of("configurations"), "at least one");
  if (experiment.checks.empty()) fail_at(*checks, reader.path_of("checks"), "at least one");
  return experiment;
}

std::string bounds_text(const ExperimentCheck& check) {
  std::string text;
  if (check.min) text += " at least " + readable_text(*check.min);
  if (check.max) text += (check.min ? " and at most " : " at most ") + readable_text(*check.max);
  return text;
}

}  // namespace

std::size_t Experiment::index_of(const std::string& configuration) const {
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    if (configurations[i].name == configuration) return i;
  }
  throw std::out_of_range(id + ": no configuration " + configuration);
}

std::vector<Experiment> read_experiments(const std::filesystem::path& path) {
  const ConfigNode file = read_yaml_file(path);
  ConfigReader reader(file, "");
  const ConfigNode* list = reader.find("experiments");
  require(reader, "experiments", list != nullptr, "a list of experiments");
  std::vector<Experiment> experiments;
  std::set<std::string> ids;
  for (const ConfigNode& item : list_of(*list, "experiments")) {
    experiments.push_back(experiment_of(item, "experiments[" + std::to_string(experiments.size()) + "]"));
    if (!ids.insert(experiments.back().id).second) fail_at(item, "id", "each id once");
  }
  reader.finish();
  return experiments;
}

std::string describe(const ExperimentCheck& check) {
  const std::string figure = "median " + check.figure;
  switch (check.kind) {
    case ExperimentCheck::Kind::kBound:
      return figure + " of " + words_of(check.configurations, ", ") + bounds_text(check);
    case ExperimentCheck::Kind::kOrder:
      return figure + ": " + words_of(check.configurations, " < ") + ", each gap beyond its 95 % interval";
    case ExperimentCheck::Kind::kRising:
      return figure + ": " + words_of(check.configurations, " ≤ ");
    case ExperimentCheck::Kind::kRatio:
      return figure + " ratio " + words_of(check.configurations, " / ") + bounds_text(check);
    case ExperimentCheck::Kind::kOk:
      return "share of runs ok of " + words_of(check.configurations, ", ") + bounds_text(check);
  }
  return {};
}

}  // namespace plumbline
