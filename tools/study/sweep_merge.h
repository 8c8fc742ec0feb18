#pragma once

#include <filesystem>
#include <vector>

#include "tools/study/run_rows.h"
#include "tools/study/sweep_directory.h"

namespace plumbline {

struct MergedSweep {
  SweepPlan plan;
  std::vector<RunRow> rows;
};

/// Brings runs of the same sweep that were made in other directories into a held one, with their own directories
/// copied.
/// @throws InputError as below
void merge_into(SweepDirectory& target, const SweepPlan& plan, const std::vector<std::filesystem::path>& sources);

/// Brings the runs of one sweep together that were made in several directories, with their own directories copied.
/// What comes out can be resumed like any sweep. `target` may itself hold what an earlier merge left.
/// @throws InputError if a source is no sweep or another one, or two hold different results of the same run
MergedSweep merge_sweeps(const std::vector<std::filesystem::path>& sources, const std::filesystem::path& target);

}  // namespace plumbline
