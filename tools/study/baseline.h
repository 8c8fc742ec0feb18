#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/output/provenance.h"
#include "tools/study/measured_run.h"
#include "tools/study/suite_file.h"

namespace plumbline {

/// What a suite's runs gave once, kept in a file to compare later runs with.
struct Baseline {
  std::string suite;
  std::string suite_digest;  ///< see suite_digest()
  std::string estimator;     ///< names, separated by commas
  std::string program;       ///< version and commit
  Machine machine;
  std::vector<MeasuredRun> runs;  ///< by scenario and seed
};

Baseline baseline_of(const SuiteFile& suite, const SweepPlan& plan, const std::vector<StoredRun>& stored);

constexpr int kBaselineSchemaVersion = 2;

/// JSON, a line per run, so that changes of it can be read; numbers to five digits.
std::string baseline_json(const Baseline& baseline);

/// @throws InputError naming the file and key for a file that cannot be read, is cut short, too large, of another
/// schema, or holds what no run can give
Baseline read_baseline(const std::filesystem::path& path);

}  // namespace plumbline
