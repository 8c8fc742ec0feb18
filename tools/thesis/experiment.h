#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

/// One way of running an experiment's scenario.
struct Configuration {
  std::string name;
  std::string estimator;               ///< empty: the scenario's
  std::vector<std::string> overrides;  ///< KEY=VALUE
};

/// What has to hold of a figure of result.json, on its medians over the seeds.
struct ExperimentCheck {
  enum class Kind {
    kBound,   ///< of each configuration: its median lies between min and max
    kOrder,   ///< medians rise along the configurations, each by a gap whose 95 % interval leaves out zero
    kRising,  ///< medians rise along the configurations or stay
    kRatio,   ///< of the first configuration to the second, seed by seed: the median lies between min and max
    kOk       ///< the share of each configuration's runs whose status is ok is at least min
  };
  Kind kind = Kind::kBound;
  std::string figure;  ///< key of result.json, dots leading into nested objects
  std::vector<std::string> configurations;
  std::optional<double> min;
  std::optional<double> max;
};

/// A claim of the thesis, and what is run to see whether it holds here.
struct Experiment {
  std::string id;
  std::string claim;
  std::string thesis;  ///< its figure
  std::filesystem::path scenario;
  std::string figure;              ///< the one that stands for the row
  std::optional<double> length_m;  ///< of the thesis's path: a shorter run does not count as holding
  double simulated_s = 0.0;        ///< of one run, about: what its cost is estimated from
  std::vector<std::uint64_t> seeds;
  std::vector<Configuration> configurations;
  std::vector<ExperimentCheck> checks;

  /// Index of a configuration. @throws std::out_of_range
  std::size_t index_of(const std::string& configuration) const;
};

/// A file of `experiments: [...]`, each with id, claim, thesis, scenario (relative to the file), figure, length_m
/// (optional), simulated_s, seeds (a count from 3, or a list of at least as many), configurations [{name, estimator,
/// set: {KEY: VALUE}}] (the last two optional) and checks. A check is one of {max, min, of} (of: a list of
/// configurations, all by default), {order: [A, B, ...]}, {rising: [...]}, {ratio: [A, B], max, min} and {ok: SHARE,
/// of}, each with a figure of its own if it is not the row's.
/// @throws InputError for anything missing, malformed, unknown or twice
std::vector<Experiment> read_experiments(const std::filesystem::path& path);

/// "median drift_percent of vloam at most 0.15": what a check asks for, in words.
std::string describe(const ExperimentCheck& check);

}  // namespace plumbline
