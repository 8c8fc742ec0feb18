#include "tools/thesis/results.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scenarios/input_error.h"

namespace plumbline {
namespace {

using nlohmann::ordered_json;

ordered_json text_or_null(const std::string& text) { return text.empty() ? ordered_json(nullptr) : ordered_json(text); }

ordered_json verdict_json(const std::optional<bool>& holds) {
  return holds ? ordered_json(*holds) : ordered_json(nullptr);
}

ordered_json row_json(const RowResult& row) {
  ordered_json checks = ordered_json::array();
  for (const CheckOutcome& check : row.judgement.checks) {
    checks.push_back(
        {{"check", check.check}, {"measured", text_or_null(check.measured)}, {"holds", verdict_json(check.holds)}});
  }
  ordered_json figures = ordered_json::object();
  for (const ConfigurationFigures& of : row.judgement.figures) figures[of.configuration] = of.values;
  return {{"id", row.id},
          {"claim", row.claim},
          {"thesis", row.thesis},
          {"ours", text_or_null(row.judgement.ours)},
          {"spread", text_or_null(row.judgement.spread)},
          {"seeds", row.judgement.seeds},
          {"holds", verdict_json(row.judgement.holds)},
          {"version", text_or_null(row.version)},
          {"note", text_or_null(row.judgement.note)},
          {"checks", checks},
          {"figures", figures}};
}

std::string text_of(const ordered_json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() || found->is_null() ? std::string() : found->get<std::string>();
}

std::optional<bool> verdict_of(const ordered_json& json) {
  const auto found = json.find("holds");
  return found == json.end() || found->is_null() ? std::nullopt : std::optional(found->get<bool>());
}

RowResult row_of(const ordered_json& json) {
  RowResult row;
  row.id = text_of(json, "id");
  row.claim = text_of(json, "claim");
  row.thesis = text_of(json, "thesis");
  row.version = text_of(json, "version");
  row.judgement.ours = text_of(json, "ours");
  row.judgement.spread = text_of(json, "spread");
  row.judgement.note = text_of(json, "note");
  row.judgement.seeds = json.at("seeds").get<std::size_t>();
  row.judgement.holds = verdict_of(json);
  for (const ordered_json& check : json.at("checks")) {
    row.judgement.checks.push_back({text_of(check, "check"), text_of(check, "measured"), verdict_of(check)});
  }
  for (const auto& [configuration, values] : json.at("figures").items()) {
    row.judgement.figures.push_back({configuration, values.get<std::vector<double>>()});
  }
  return row;
}

bool same_checks(const RowResult& a, const RowResult& b) {
  return std::equal(a.judgement.checks.begin(), a.judgement.checks.end(), b.judgement.checks.begin(),
                    b.judgement.checks.end(),
                    [](const CheckOutcome& x, const CheckOutcome& y) { return x.check == y.check; });
}

}  // namespace

RowResult row_result(const Experiment& experiment, const std::vector<std::vector<std::optional<RunRow>>>& runs,
                     const std::string& impossible, const std::string& version) {
  RowResult row{experiment.id, experiment.claim, experiment.thesis, judge(experiment, runs), {}};
  if (!impossible.empty()) {
    row.judgement.note += (row.judgement.note.empty() ? "" : "; ") + ("cannot be run by this version: " + impossible);
  }
  const bool begun = std::any_of(runs.begin(), runs.end(), [](const auto& of) {
    return std::any_of(of.begin(), of.end(), [](const auto& run) { return run.has_value(); });
  });
  if (begun) row.version = version;
  return row;
}

RowResult newer(const RowResult& now, const std::vector<RowResult>& before) {
  const auto old = std::find_if(before.begin(), before.end(), [&](const RowResult& row) { return row.id == now.id; });
  if (old == before.end() || now.judgement.holds || !same_checks(*old, now)) return now;
  if (!old->judgement.holds && !now.version.empty()) return now;
  if (old->version.empty()) return now;
  RowResult kept = *old;
  kept.claim = now.claim;
  kept.thesis = now.thesis;
  return kept;
}

std::string results_json(const std::vector<RowResult>& rows) {
  ordered_json list = ordered_json::array();
  for (const RowResult& row : rows) list.push_back(row_json(row));
  return ordered_json{{"rows", list}}.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::vector<RowResult> read_results(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<RowResult> rows;
  try {
    const ordered_json results = ordered_json::parse(text);
    for (const ordered_json& row : results.at("rows")) rows.push_back(row_of(row));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(path.string() + ": found no results of the thesis suite (" + error.what() +
                     "), expected what it wrote itself");
  }
  return rows;
}

}  // namespace plumbline
