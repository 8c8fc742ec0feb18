#include "tools/report/regression.h"

#include <cmath>

#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

std::string place_of(const Change& change) {
  return change.scenario.empty() ? "over the whole suite" : "in " + change.scenario;
}

std::string sentence(const Change& change, const char* verb) {
  return change.figure->title + " " + verb + " by " + growth_text(change) + " " + place_of(change) + ": " +
         readable_text(change.before) + " → " + readable_text(change.after) + " " + change.figure->unit;
}

std::string run_name(const RunPair& pair) {
  return pair.after->scenario + ", seed " + std::to_string(pair.after->seed);
}

}  // namespace

Regression make_regression(Baseline before, Baseline after, const Effects& effects) {
  Regression regression;
  regression.suite = after.suite;
  regression.before = std::move(before);
  regression.after = std::move(after);
  const std::string& here = regression.after.machine.cpu;
  const std::string& there = regression.before.machine.cpu;
  if (here != there) {
    regression.notes.push_back("the baseline was made on another class of machine (" + there + "; here " + here +
                               "): time and memory are only shown; errors are compared, as numbers that rounding "
                               "changes a little everywhere");
  }
  if (regression.before.estimator != regression.after.estimator) {
    regression.notes.push_back("the baseline is of another estimator (" + regression.before.estimator + "; here " +
                               regression.after.estimator + ")");
  }
  regression.comparison = compare_runs(regression.before.runs, regression.after.runs, effects, here == there);
  regression.unpaired_percent = detectable_unpaired_percent(regression.comparison);
  return regression;
}

std::vector<std::string> failures(const Regression& regression) {
  const Comparison& comparison = regression.comparison;
  std::vector<std::string> texts;
  for (const RunPair& pair : comparison.without_result) {
    texts.push_back(run_name(pair) + " ends in an error: " + pair.after->reason);
  }
  for (const Change& change : comparison.changes) {
    if (change.worse) texts.push_back(sentence(change, "grew"));
  }
  if (comparison.status.worse) {
    texts.push_back(std::to_string(comparison.status.newly_failing.size()) + " of " +
                    std::to_string(comparison.pairs.size()) + " runs that were ok are not, " +
                    std::to_string(comparison.status.newly_ok.size()) + " became ok");
  }
  return texts;
}

std::vector<std::string> improvements(const Regression& regression) {
  std::vector<std::string> texts;
  for (const Change& change : regression.comparison.changes) {
    if (change.better) texts.push_back(sentence(change, "changed"));
  }
  return texts;
}

std::string growth_text(const Change& change) {
  if (change.pairs == 0) return "–";
  std::string value = change.percent.value > 0.0 ? "+" : "";
  value += readable_text(change.percent.value) + " %";
  if (!std::isfinite(change.percent.high)) return value;
  return value + " (" + readable_text(change.percent.low) + " … " + readable_text(change.percent.high) + ")";
}

std::string detectable_text(double percent) { return std::isfinite(percent) ? readable_text(percent) + " %" : "none"; }

}  // namespace plumbline
