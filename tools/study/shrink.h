#pragma once

#include <filesystem>
#include <string>

#include "tools/study/sweep_plan.h"

namespace plumbline {

/// Reduces a failing run to the simplest scenario that still fails in the same way (same status; without a result, the
/// same outcome): a shorter motion first, then every key at its default whose own value is not needed. Writes
/// OUT/shrunk/KEY.yaml, a scenario that stands alone, and says what it took.
/// @returns the exit code
/// @throws InputError if the run is not in the directory, or did not fail
int shrink_run(const SweepFile& sweep, const SweepPlan& plan, const std::string& key, const std::filesystem::path& out,
               int jobs, const std::string& program);

}  // namespace plumbline
