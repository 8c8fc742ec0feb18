#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/regress_figures.h"
#include "tools/study/study_keys.h"

namespace plumbline {

/// One scenario of a suite.
struct SuiteScenario {
  std::string name;
  std::filesystem::path path;
  std::vector<std::string> fixed;  ///< KEY=VALUE, the suite's own first
};

/// A suite: scenarios that are run over the same seeds and compared with a baseline, run by run.
struct SuiteFile {
  std::string name;  ///< the file's stem
  std::filesystem::path path;
  std::vector<SuiteScenario> scenarios;  ///< by name
  std::vector<std::uint64_t> seeds;      ///< ascending
  RunLimits limits;
  Effects effects;  ///< changes smaller than these never fail
};

/// A single run tells nothing of how much runs differ, two hardly anything.
constexpr std::size_t kLeastSuiteSeeds = 3;

/// Keys: scenarios {NAME: FILE | {scenario: FILE, set {KEY: VALUE}}}, set {KEY: VALUE}, seeds [N, ...] or a count,
/// limits {time_s, memory_mb}, effects_percent {FIGURE: PERCENT}.
/// @throws InputError for anything missing, malformed, unknown or twice
SuiteFile read_suite_file(const std::filesystem::path& path);

}  // namespace plumbline
