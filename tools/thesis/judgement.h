#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/run_rows.h"
#include "tools/thesis/experiment.h"

namespace plumbline {

/// How a check came out; nothing while runs are missing that it needs.
struct CheckOutcome {
  std::string check;     ///< in words
  std::string measured;  ///< likewise; empty while nothing is
  std::optional<bool> holds;
};

/// A configuration's values of the row's figure, in the order of the seeds; a run without the figure is left out.
struct ConfigurationFigures {
  std::string configuration;
  std::vector<double> values;
};

/// What the runs of a row say about its claim.
struct Judgement {
  std::string ours;       ///< medians; empty while there are none
  std::string spread;     ///< smallest … largest over the seeds
  std::string note;       ///< missing runs, runs that are not ok, a path shorter than the thesis's
  std::size_t seeds = 0;  ///< that every configuration has run
  std::optional<bool> holds;
  std::vector<CheckOutcome> checks;
  std::vector<ConfigurationFigures> figures;
};

/// @param runs  of each configuration, of each seed: in the experiment's order; nothing where it has not ended
Judgement judge(const Experiment& experiment, const std::vector<std::vector<std::optional<RunRow>>>& runs);

}  // namespace plumbline
