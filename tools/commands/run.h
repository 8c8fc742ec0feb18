#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/commands/map_options.h"

namespace plumbline {

struct RunArguments {
  std::string scenario;
  std::vector<std::string> overrides;  ///< KEY=VALUE
  std::optional<std::uint64_t> seed;
  std::string estimator;  ///< empty: the scenario's
  std::string out;        ///< empty: out/NAME-SEED
  MapArguments map;
  bool detectors = false;  ///< writes detectors.csv and truth_degeneracy.csv, too
  int threads = 0;         ///< 0: as many as the machine has
};

/// Runs one scenario, judges it, writes its directory and prints a summary. @returns the program's exit code
int run_scenario(const RunArguments& arguments);

}  // namespace plumbline
