#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/sweep_plan.h"
#include "tools/thesis/experiment.h"

namespace plumbline {

/// One run of an experiment: a configuration with a seed.
struct ThesisRun {
  PlannedRun
      planned;  ///< its key is scenario digest, seed and program version: the same run has the same key in any row
  std::string label;  ///< "ch5_campus vloam seed 1"
  std::filesystem::path scenario;
  std::vector<std::string> overrides;    ///< KEY=VALUE, of the scenario
  std::vector<std::string> replay_keys;  ///< KEY=VALUE: all that a replay of its sensors has to be told
  std::string stream;                    ///< of its sensors: runs with the same one differ in their estimator alone
};

/// The runs of an experiment: of each configuration, of each seed.
struct ThesisRow {
  Experiment experiment;
  std::vector<std::vector<ThesisRun>> runs;  ///< none of a configuration that this program cannot run
  std::string impossible;                    ///< why it cannot; empty if it can run all
};

/// Loads the scenario of every run once. What this program cannot run, for want of an estimator or a scene, stays in
/// the plan and says why.
/// @param program  version that makes the runs
std::vector<ThesisRow> plan_thesis(const std::vector<Experiment>& experiments, const std::string& program);

}  // namespace plumbline
