#pragma once

#include <string>
#include <vector>

#include "tests/scenarios/temporary_directory.h"
#include "tools/thesis/experiment.h"

namespace plumbline {

/// A table of one row: configurations a, b and c of a scenario beside it, three seeds, drift the figure.
inline std::vector<Experiment> experiment_of(const TemporaryDirectory& directory, const std::string& checks,
                                             const std::string& more = "") {
  directory.write("scenario.yaml", "motion:\n  waypoints: [[4, 4.75, 1.5], [24, 4.75, 1.5]]\n");
  return read_experiments(
      directory.write("experiments.yaml",
                      "experiments:\n"
                      "  - {id: row, claim: c, thesis: t, scenario: scenario.yaml, figure: drift_percent, seeds: 3,\n"
                      "     simulated_s: 10, configurations: [{name: a}, {name: b, estimator: vio},\n"
                      "     {name: c, set: {rig.decimation: 2}}], checks: [" +
                          checks + "]" + more + "}\n"));
}

}  // namespace plumbline
