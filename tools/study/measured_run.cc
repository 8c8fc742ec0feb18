#include "tools/study/measured_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <tuple>

#include "tools/study/suite_plan.h"

namespace plumbline {
namespace {

using nlohmann::json;

/// An empty object for a run without a result.
json parsed(const std::string& text) {
  json result = json::parse(text, nullptr, /*allow_exceptions=*/false);
  return result.is_object() ? result : json::object();
}

std::vector<double> by_second(const json& result, const char* key) {
  std::vector<double> values;
  for (const json& value : result.value(key, json::array())) {
    values.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

/// Both factors are simulated seconds over wall seconds, of the estimator's calls and of the whole run.
std::optional<double> estimator_time_ratio(const json& result) {
  const json whole = result.value("real_time_factor", json());
  const json estimator = result.value("estimator_real_time_factor", json());
  if (!whole.is_number() || !estimator.is_number()) return std::nullopt;
  const double times_as_fast = estimator.get<double>() / whole.get<double>();
  return times_as_fast > 1.0 ? std::optional(1.0 / (times_as_fast - 1.0)) : std::nullopt;
}

}  // namespace

bool before_in_suite(const MeasuredRun& a, const MeasuredRun& b) {
  return std::tie(a.scenario, a.seed) < std::tie(b.scenario, b.seed);
}

std::vector<MeasuredRun> measured_runs(const SweepPlan& plan, const std::vector<StoredRun>& stored) {
  std::vector<MeasuredRun> runs;
  for (const StoredRun& from : stored) {
    const std::vector<RunRow> rows = run_rows(plan, {from});
    if (rows.empty()) continue;
    const RunRow& row = rows.front();
    const json result = parsed(from.result);
    runs.push_back({suite_scenario_of(row.run), row.run.seed, row.run.key, row.status, row.reason,
                    by_second(result, "rpe_by_second_m"), by_second(result, "rpe_by_second_deg"),
                    row.figure("drift_percent"), row.figure("progress_ratio"), estimator_time_ratio(result), row.cpu_s,
                    row.peak_memory_mb});
  }
  std::sort(runs.begin(), runs.end(), before_in_suite);
  return runs;
}

}  // namespace plumbline
