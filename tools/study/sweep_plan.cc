#include "tools/study/sweep_plan.h"

#include <algorithm>
#include <cmath>

#include "scenarios/scenario.h"
#include "tools/output/provenance.h"
#include "tools/study/sampling.h"

namespace plumbline {
namespace {

constexpr std::size_t kMostRuns = 100'000;

using Values = std::vector<AxisValue>;

AxisValue sampled_value(const SweepAxis& axis, double share) {
  const auto [from, to] = *axis.range;
  const double number = axis.logarithmic ? from * std::pow(to / from, share) : from + share * (to - from);
  return rounded_value(number);
}

/// One row per point of the sample; the columns of axes that are not sampled stay empty.
std::vector<Values> sample_rows(const SweepFile& sweep) {
  if (!sweep.sample) return {Values(sweep.axes.size())};
  std::vector<std::string> names;
  for (const SweepAxis& axis : sweep.axes) {
    if (axis.is_sampled()) names.push_back(axis.key);
  }
  const UnitPoints points = sweep.sample->kind == SweepSample::Kind::kSobol
                                ? sobol_points(sweep.sample->count, names.size())
                                : latin_hypercube(sweep.sample->count, names);
  std::vector<Values> rows;
  for (const std::vector<double>& point : points) {
    Values row(sweep.axes.size());
    std::size_t column = 0;
    for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
      if (sweep.axes[a].is_sampled()) row[a] = sampled_value(sweep.axes[a], point[column++]);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

[[noreturn]] void fail_too_many(const SweepFile& sweep) {
  throw InputError(sweep.path.string() + ": found more than " + std::to_string(kMostRuns) +
                   " runs, which is the most a sweep may have");
}

/// Crosses every row with every value of the listed axes.
std::vector<Values> crossed_rows(const SweepFile& sweep) {
  std::vector<Values> rows = sample_rows(sweep);
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (sweep.axes[a].is_sampled()) continue;
    if (rows.size() * sweep.axes[a].values.size() > kMostRuns) fail_too_many(sweep);
    std::vector<Values> wider;
    for (const Values& row : rows) {
      for (const AxisValue& value : sweep.axes[a].values) {
        wider.push_back(row);
        wider.back()[a] = value;
      }
    }
    rows = std::move(wider);
  }
  return rows;
}

bool row_before(const Values& a, const Values& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].number && b[i].number) {
      if (*a[i].number != *b[i].number) return *a[i].number < *b[i].number;
    } else if (a[i].text != b[i].text) {
      return a[i].text < b[i].text;
    }
  }
  return false;
}

std::string padded(std::size_t number, std::size_t width) {
  const std::string digits = std::to_string(number);
  return std::string(width > digits.size() ? width - digits.size() : 0, '0') + digits;
}

Scenario scenario_of(const SweepFile& sweep, const SweepPlan& plan, const PlannedRun& run) {
  std::vector<std::string> overrides = overrides_of(plan, run);
  if (!run.estimator.empty()) overrides.push_back("estimator.name=" + run.estimator);
  try {
    return load_scenario(sweep.scenario, overrides, run.seed);
  } catch (const InputError& error) {
    throw InputError(sweep.path.string() + ": the scenario refuses a run (" + describe(plan, run) +
                     "): " + error.what());
  }
}

/// What the scenario itself says where the sweep says nothing.
void take_defaults(const SweepFile& sweep, SweepPlan& plan) {
  if (!plan.seeds.empty() && !plan.estimators.empty()) return;
  const Scenario scenario = load_scenario(sweep.scenario, {}, {});
  if (plan.seeds.empty()) plan.seeds = {scenario.seed};
  if (plan.estimators.empty()) plan.estimators = {scenario.estimator_name};
}

}  // namespace

const PlannedRun* SweepPlan::find(const std::string& key) const {
  const auto found = std::lower_bound(
      runs.begin(), runs.end(), key, [](const PlannedRun& run, const std::string& wanted) { return run.key < wanted; });
  return found != runs.end() && found->key == key ? &*found : nullptr;
}

std::optional<std::size_t> SweepPlan::boundary() const {
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].key == boundary_axis) return a;
  }
  return std::nullopt;
}

SweepPlan make_plan(const SweepFile& sweep) {
  SweepPlan plan{sweep.name,          sweep.scenario.stem().string(),
                 sweep.axes,          sweep.sample,
                 sweep.fixed,         sweep.estimators,
                 sweep.seeds,         sweep.limits,
                 sweep.boundary_axis, sweep.detectors,
                 program_version(),   {}};
  take_defaults(sweep, plan);
  std::vector<Values> rows = crossed_rows(sweep);
  std::sort(rows.begin(), rows.end(), row_before);
  const std::size_t count = rows.size() * plan.estimators.size() * plan.seeds.size();
  if (count > kMostRuns) fail_too_many(sweep);

  const std::size_t width = std::max<std::size_t>(4, std::to_string(count - 1).size());
  for (const Values& row : rows) {
    for (const std::string& estimator : plan.estimators) {
      for (const std::uint64_t seed : plan.seeds) {
        PlannedRun run{padded(plan.runs.size(), width), row, estimator, seed, {}};
        run.scenario_digest = scenario_of(sweep, plan, run).digest;
        plan.runs.push_back(std::move(run));
      }
    }
  }
  return plan;
}

std::vector<std::string> overrides_of(const SweepPlan& plan, const PlannedRun& run) {
  std::vector<std::string> overrides = plan.fixed;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    overrides.push_back(plan.axes[a].key + "=" + run.values[a].text);
  }
  return overrides;
}

std::string describe(const SweepPlan& plan, const PlannedRun& run) {
  std::string text;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) text += plan.axes[a].key + " = " + run.values[a].text + ", ";
  return text + run.estimator + ", seed " + std::to_string(run.seed);
}

}  // namespace plumbline
