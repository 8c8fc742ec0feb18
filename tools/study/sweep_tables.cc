#include "tools/study/sweep_tables.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

using nlohmann::ordered_json;
using Columns = std::vector<std::string>;

/// Every key that some row has, in the order of their first appearance.
Columns columns_of(const std::vector<RunRow>& rows, FigureTexts RunRow::*figures) {
  Columns columns;
  for (const RunRow& row : rows) {
    for (const auto& [key, value] : row.*figures) {
      if (std::find(columns.begin(), columns.end(), key) == columns.end()) columns.push_back(key);
    }
  }
  return columns;
}

/// A comma, and the text so quoted that it stays one cell.
void append_cell(std::string& line, const std::string& text) {
  line += ',';
  const bool is_plain = text.find_first_of(",\"\n\r") == std::string::npos;
  if (!is_plain) line += '"';
  for (const char c : text) {
    if (c == '"') line += '"';
    line += c;
  }
  if (!is_plain) line += '"';
}

void append_cells(std::string& line, const Columns& columns, const FigureTexts& figures) {
  for (const std::string& column : columns) {
    const auto found =
        std::find_if(figures.begin(), figures.end(), [&](const auto& figure) { return figure.first == column; });
    line += ',';
    if (found != figures.end() && found->second != "null") line += found->second;
  }
}

ordered_json axis_json(const AxisValue& value) {
  if (value.number) return *value.number;
  if (value.text == "true" || value.text == "false") return value.text == "true";
  return value.text;
}

std::string dump(const ordered_json& json) { return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace); }

}  // namespace

std::string table_csv(const SweepPlan& plan, const std::vector<RunRow>& rows) {
  const Columns figures = columns_of(rows, &RunRow::figures);
  std::string text = "run";
  for (const SweepAxis& axis : plan.axes) append_cell(text, axis.key);
  text += ",estimator,seed,scenario_digest,outcome,status,reason";
  for (const std::string& figure : figures) append_cell(text, figure);
  text += '\n';
  for (const RunRow& row : rows) {
    text += row.run.key;
    for (const AxisValue& value : row.run.values) append_cell(text, value.text);
    for (const std::string& word : {row.run.estimator, std::to_string(row.run.seed), row.run.scenario_digest,
                                    row.outcome, row.status, row.reason}) {
      append_cell(text, word);
    }
    append_cells(text, figures, row.figures);
    text += '\n';
  }
  return text;
}

std::string table_jsonl(const SweepPlan& plan, const std::vector<RunRow>& rows) {
  const Columns figures = columns_of(rows, &RunRow::figures);
  std::string text;
  for (const RunRow& row : rows) {
    ordered_json line;
    line["run"] = row.run.key;
    for (std::size_t a = 0; a < plan.axes.size(); ++a) line[plan.axes[a].key] = axis_json(row.run.values[a]);
    line["estimator"] = row.run.estimator;
    line["seed"] = row.run.seed;
    line["scenario_digest"] = row.run.scenario_digest;
    line["outcome"] = row.outcome;
    line["status"] = row.status;
    line["reason"] = row.reason;
    for (const std::string& figure : figures) line[figure] = nullptr;
    for (const auto& [key, value] : row.figures) line[key] = ordered_json::parse(value);
    text += dump(line) + "\n";
  }
  return text;
}

std::string sweep_timing_csv(const std::vector<RunRow>& rows) {
  const Columns timings = columns_of(rows, &RunRow::timings);
  std::string text = "run,process_wall_s,process_cpu_s,peak_memory_mb";
  for (const std::string& timing : timings) append_cell(text, timing);
  text += '\n';
  for (const RunRow& row : rows) {
    text += row.run.key;
    append_cell(text, fixed_text(row.wall_s, 3));
    append_cell(text, fixed_text(row.cpu_s, 3));
    append_cell(text, fixed_text(row.peak_memory_mb, 1));
    append_cells(text, timings, row.timings);
    text += '\n';
  }
  return text;
}

}  // namespace plumbline
