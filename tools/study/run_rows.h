#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/study/study_store.h"
#include "tools/study/sweep_plan.h"

namespace plumbline {

/// A figure as result.json spells it: a number, true, false or null.
using FigureTexts = std::vector<std::pair<std::string, std::string>>;

/// A run that has ended, ready for tables and charts.
struct RunRow {
  PlannedRun run;
  std::string outcome;
  std::string status;  ///< of the result; "error" without one
  std::string reason;
  FigureTexts figures;  ///< what the same run gives on any machine as fast or slow
  FigureTexts timings;  ///< what depends on the clock
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_memory_mb = 0.0;

  bool is_ok() const { return status == "ok"; }
  /// A number under its key; nothing if it is null or not there.
  std::optional<double> figure(const std::string& key) const;
};

/// @param stored  what became of `run`
RunRow run_row(const PlannedRun& run, const StoredRun& stored);

/// The stored runs that the plan knows, by key.
std::vector<RunRow> run_rows(const SweepPlan& plan, const std::vector<StoredRun>& stored);

}  // namespace plumbline
