#include "tools/study/run_rows.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

namespace plumbline {
namespace {

using nlohmann::ordered_json;

/// What the table says in columns of its own, or what does not belong into it.
constexpr std::array<std::string_view, 10> kNoFigures = {
    "schema_version",    "status", "fault",     "scenario", "seed", "estimator", "rpe_by_second_m",
    "rpe_by_second_deg", "checks", "provenance"};

bool is_wall_clock(const std::string& key) {
  return key == "wall_s" || key.ends_with("real_time_factor") || key.ends_with("_ms");
}

void put(const std::string& key, const ordered_json& value, RunRow& row) {
  (is_wall_clock(key) ? row.timings : row.figures).emplace_back(key, value.dump());
}

/// Walks nested objects; words are left out, for tables of numbers.
void flatten(const std::string& key, const ordered_json& value, RunRow& row) {
  if (key.ends_with(".dropped") && value.is_object()) {
    std::int64_t dropped = 0;
    for (const auto& [reason, count] : value.items()) dropped += count.is_number() ? count.get<std::int64_t>() : 0;
    put(key, dropped, row);
  } else if (value.is_object()) {
    for (const auto& [name, inner] : value.items()) flatten(key + "." + name, inner, row);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) flatten(key + "." + std::to_string(i), value[i], row);
  } else if (!value.is_string()) {
    put(key, value, row);
  }
}

}  // namespace

RunRow run_row(const PlannedRun& run, const StoredRun& stored) {
  RunRow row;
  row.run = run;
  row.outcome = stored.outcome;
  row.status = "error";
  row.reason = stored.reason;
  row.wall_s = stored.wall_s;
  row.cpu_s = stored.cpu_s;
  row.peak_memory_mb = stored.peak_memory_mb;
  const ordered_json result = ordered_json::parse(stored.result, nullptr, /*allow_exceptions=*/false);
  if (!result.is_object()) return row;
  row.status = result.value("status", "error");
  for (const auto& [key, value] : result.items()) {
    if (std::find(kNoFigures.begin(), kNoFigures.end(), key) == kNoFigures.end()) flatten(key, value, row);
  }
  return row;
}

std::optional<double> RunRow::figure(const std::string& key) const {
  const auto found =
      std::find_if(figures.begin(), figures.end(), [&](const auto& figure) { return figure.first == key; });
  if (found == figures.end()) return std::nullopt;
  const ordered_json value = ordered_json::parse(found->second);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::vector<RunRow> run_rows(const SweepPlan& plan, const std::vector<StoredRun>& stored) {
  std::vector<RunRow> rows;
  for (const StoredRun& run : stored) {
    if (const PlannedRun* planned = plan.find(run.key)) rows.push_back(run_row(*planned, run));
  }
  return rows;
}

}  // namespace plumbline
