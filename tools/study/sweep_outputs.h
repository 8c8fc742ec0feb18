#pragma once

#include <filesystem>
#include <vector>

#include "tools/study/run_rows.h"

namespace plumbline {

/// Writes what people and programs read of a sweep: table.csv, table.jsonl, timing.csv, boundary.csv, detectors.csv,
/// report.html and charts/*.svg, each whole or not at all.
/// @throws InputError if one cannot be written
void write_sweep_outputs(const std::filesystem::path& root, const SweepPlan& plan, const std::vector<RunRow>& rows);

}  // namespace plumbline
