#include "tools/evaluation/verdict.h"

#include <algorithm>

#include "tools/exit_code.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

const Figure* find_figure(const std::vector<Figure>& figures, const std::string& key) {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const Figure& f) { return f.key == key; });
  return found == figures.end() ? nullptr : &*found;
}

bool within(const Expectation& bound, double value) {
  return (!bound.min || value >= *bound.min) && (!bound.max || value <= *bound.max);
}

std::vector<Check> check_bounds(const std::vector<Expectation>& bounds, const RunFigures& figures) {
  const std::vector<Figure> list = figure_list(figures);
  std::vector<Check> checks;
  for (const Expectation& bound : bounds) {
    const Figure* figure = find_figure(list, bound.key);
    Check check{bound, figure != nullptr ? figure->value : std::nullopt, false};
    check.holds = check.value && within(bound, *check.value);
    checks.push_back(check);
  }
  return checks;
}

Status status_of(const RunRecord& record, const RunFigures& figures, bool bounds_hold) {
  if (!record.fault.empty()) return Status::kError;
  if (record.estimator_lost || figures.trajectory.lost_since_s) return Status::kLost;
  return bounds_hold ? Status::kOk : Status::kFailed;
}

}  // namespace

std::string to_string(Status status) {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kFailed:
      return "failed";
    case Status::kLost:
      return "lost";
    case Status::kError:
      return "error";
  }
  return "error";
}

int Verdict::exit_code() const {
  if (status == Status::kError && expected_status != to_string(Status::kError)) return kExitFault;
  return holds ? kExitDone : kExitCheckFailed;
}

Verdict judge(const Scenario& scenario, const RunRecord& record, const RunFigures& figures) {
  Verdict verdict;
  verdict.expected_status = scenario.expect_status;
  verdict.checks = check_bounds(scenario.expect, figures);
  const bool bounds_hold =
      std::all_of(verdict.checks.begin(), verdict.checks.end(), [](const Check& check) { return check.holds; });
  verdict.status = status_of(record, figures, bounds_hold);

  const bool status_as_expected = !scenario.expect_status || *scenario.expect_status == to_string(verdict.status);
  const bool failure_expected = scenario.expect_status == to_string(Status::kFailed);
  verdict.holds = status_as_expected && (bounds_hold || failure_expected);
  // An ok run that was expected to be lost has failed its `expect:`.
  if (verdict.status == Status::kOk && !status_as_expected) verdict.status = Status::kFailed;
  return verdict;
}

std::string describe(const Check& check) {
  const Expectation& bound = check.expectation;
  std::string text = bound.key + " = " + (check.value ? readable_text(*check.value) : "null") + ", expected ";
  if (bound.min) text += "at least " + readable_text(*bound.min);
  if (bound.min && bound.max) text += ", ";
  if (bound.max) text += "at most " + readable_text(*bound.max);
  return text;
}

}  // namespace plumbline
