#pragma once

#include <string>
#include <vector>

#include "tools/study/run_rows.h"

/// The tables of a sweep. Rows come sorted by run key; a column that some runs lack is empty there.
namespace plumbline {

/// table.csv: run, a column per axis, estimator, seed, scenario_digest, outcome, status, reason, and every figure of
/// result.json that no clock enters.
std::string table_csv(const SweepPlan& plan, const std::vector<RunRow>& rows);

/// table.jsonl: an object per run with the same columns under the same names.
std::string table_jsonl(const SweepPlan& plan, const std::vector<RunRow>& rows);

/// timing.csv: run, process_wall_s, process_cpu_s, peak_memory_mb, and the figures of result.json that a clock enters.
std::string sweep_timing_csv(const std::vector<RunRow>& rows);

}  // namespace plumbline
