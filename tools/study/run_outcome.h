#pragma once

#include <filesystem>
#include <optional>

#include "tools/study/child_process.h"
#include "tools/study/study_store.h"
#include "tools/study/sweep_plan.h"

namespace plumbline {

/// What is to be stored of a run that has ended: its result where it wrote one, else how it ended.
/// @param run_directory  where it was told to write
/// @returns nothing for a run that somebody interrupted, which is no outcome
/// @throws InputError if it ended because the disk is full, which is not its fault
std::optional<StoredRun> outcome_of(const PlannedRun& run, const ChildEnd& end, const RunLimits& limits,
                                    const std::filesystem::path& run_directory);

/// A run that finished, though the sweep ended before it was stored.
/// @returns nothing unless the directory holds the result of this very run, made by this program
std::optional<StoredRun> found_outcome(const PlannedRun& run, const std::string& program,
                                       const std::filesystem::path& run_directory);

/// Why a run is not ok, from the text of its result.json; empty if it is.
std::string reason_in_result(const std::string& result);

}  // namespace plumbline
