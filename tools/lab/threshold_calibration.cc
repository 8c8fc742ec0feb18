#include "tools/lab/threshold_calibration.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "sensors/information.h"
#include "tools/evaluation/quantile.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

using Class = DegeneracyLabel::Class;

/// The named columns of a CSV's rows that have them all.
std::vector<std::vector<std::string>> columns_of(const std::filesystem::path& path,
                                                 const std::vector<std::string>& names) {
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return {};
  const std::vector<std::string> header = split(line);
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end()) return {};
    places.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  std::vector<std::vector<std::string>> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    if (cells.size() < header.size()) continue;
    rows.emplace_back();
    for (const std::size_t place : places) rows.back().push_back(cells[place]);
  }
  return rows;
}

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

void append_line(std::string& text, const char* key, const std::optional<double>& value) {
  constexpr int kCellDigits = 6;
  text += std::string("  ") + key + ": ";
  if (value) {
    append_general(text, *value, kCellDigits);
  } else {
    text += "null";
  }
  text += '\n';
}

}  // namespace

ModuleThreshold calibrate_threshold(const std::string& module, const std::vector<LabelledSolve>& solves) {
  ModuleThreshold result;
  result.module = module;
  std::vector<double> degenerate;
  std::vector<double> well;
  for (const LabelledSolve& solve : solves) {
    (solve.degenerate ? degenerate : well).push_back(solve.least_eigenvalue);
  }
  result.degenerate = degenerate.size();
  result.well = well.size();
  result.degenerate_to = quantile(degenerate, 0.99);
  result.well_from = quantile(well, 0.01);
  if (result.degenerate_to && result.well_from) {
    // A direction without any information has an eigenvalue of zero: one is as good as none.
    result.threshold = std::sqrt(std::max(1.0, *result.degenerate_to) * std::max(1.0, *result.well_from));
  }
  return result;
}

std::vector<LabelledSolve> labelled_solves(const std::filesystem::path& run_directory, const std::string& module) {
  std::map<std::string, bool> is_degenerate;  // by stamp
  for (const auto& row : columns_of(run_directory / "truth_degeneracy.csv", {"stamp_ns", "module", "excess_1"})) {
    const auto excess = number_of(row[2]);
    if (row[1] != module || !excess) continue;
    const Class found = DegeneracyLabel::class_of(*excess);
    if (found != Class::kGrey) is_degenerate[row[0]] = found == Class::kDegenerate;
  }
  std::vector<LabelledSolve> solves;
  for (const auto& row : columns_of(run_directory / "degeneracy.csv", {"stamp_ns", "module", "lambda_1"})) {
    const auto label = is_degenerate.find(row[0]);
    const auto eigenvalue = number_of(row[2]);
    if (row[1] == module && eigenvalue && label != is_degenerate.end()) solves.push_back({*eigenvalue, label->second});
  }
  return solves;
}

std::string thresholds_yaml(const std::string& sweep, const std::vector<ModuleThreshold>& thresholds) {
  std::string text = "# Thresholds on the eigenvalues of each module's whitened J^T J, from the sweep " + sweep +
                     ":\n# the mid-point of the margin between degenerate and well-determined solves.\n";
  for (const ModuleThreshold& one : thresholds) {
    text += one.module + ":\n";
    append_line(text, "threshold", one.threshold);
    append_line(text, "degenerate_to", one.degenerate_to);
    append_line(text, "well_from", one.well_from);
    text += "  degenerate_solves: " + std::to_string(one.degenerate) + "\n";
    text += "  well_solves: " + std::to_string(one.well) + "\n";
    text += std::string("  clear_margin: ") + (one.is_clear() ? "true" : "false") + "\n";
  }
  return text;
}

}  // namespace plumbline
