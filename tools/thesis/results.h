#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/thesis/judgement.h"

namespace plumbline {

/// A row of results.json.
struct RowResult {
  std::string id;
  std::string claim;
  std::string thesis;
  Judgement judgement;
  std::string version;  ///< of the program that made the runs; empty while there are none
};

/// What the runs of this version say of an experiment.
RowResult row_result(const Experiment& experiment, const std::vector<std::vector<std::optional<RunRow>>>& runs,
                     const std::string& impossible, const std::string& version);

/// The row to publish: what this version's runs say, unless they say nothing yet and an older version's verdict on the
/// same checks stands.
RowResult newer(const RowResult& now, const std::vector<RowResult>& before);

/// {"rows": [{id, claim, thesis, ours, spread, seeds, holds, version, note, checks, figures}]}: what is not known yet
/// is null.
std::string results_json(const std::vector<RowResult>& rows);

/// @returns nothing where there is no such file. @throws InputError for a file that is no such text
std::vector<RowResult> read_results(const std::filesystem::path& path);

}  // namespace plumbline
