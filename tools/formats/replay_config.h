#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/formats/dataset.h"

namespace plumbline {

/// A dataset as something to run: what reads it, and the estimator's side and the provenance of a scenario.
struct ReplayConfig {
  DatasetSettings dataset;
  Scenario scenario;  ///< name, path, estimator, expect, text and digest; world, motion and rig say nothing
};

/// The keys of a replay: `estimator` and `expect` as a scenario's, and `dataset` (replay_keys_help()).
/// @param file  a YAML file, or empty
/// @param overrides  KEY=VALUE, laid on the file
/// @throws InputError
ReplayConfig read_replay_config(const std::filesystem::path& dataset, const std::filesystem::path& file,
                                const std::vector<std::string>& overrides);

/// The keys of `dataset` for --help.
std::string replay_keys_help();

}  // namespace plumbline
