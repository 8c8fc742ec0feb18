#include "tools/study/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace plumbline {
namespace {

constexpr double kScenarioShare = 0.5;  // of a figure's weight, over all its scenarios together
constexpr double kStatusWeight = 2.0;
constexpr double kPower95 = 1.645;  // standard errors that 95 % of a normal distribution stay above
constexpr std::size_t kLeastFailing = 2;
constexpr double kLeastFailingShare = 0.05;

double percent_of(double log_ratio) { return 100.0 * std::expm1(log_ratio); }

std::vector<RunPair> paired(const std::vector<MeasuredRun>& before, const std::vector<MeasuredRun>& after) {
  std::vector<RunPair> pairs;
  auto other = after.begin();
  for (const MeasuredRun& run : before) {
    while (other != after.end() && before_in_suite(*other, run)) ++other;
    if (other != after.end() && !before_in_suite(run, *other)) pairs.push_back({&run, &*other});
  }
  return pairs;
}

/// Logarithms of a figure in the pairs that have it on both sides, by scenario.
struct Logarithms {
  std::map<std::string, std::vector<double>> before;
  std::map<std::string, std::vector<double>> after;
};

Logarithms logarithms(const std::vector<RunPair>& pairs, const RegressFigure& figure, const std::string& scenario) {
  Logarithms logs;
  for (const RunPair& pair : pairs) {
    if (!scenario.empty() && pair.before->scenario != scenario) continue;
    const auto before = figure.value(*pair.before);
    const auto after = figure.value(*pair.after);
    if (!before || !after) continue;
    logs.before[pair.before->scenario].push_back(std::log(*before));
    logs.after[pair.before->scenario].push_back(std::log(*after));
  }
  return logs;
}

PairedStrata differences(const Logarithms& logs) {
  PairedStrata strata;
  for (const auto& [scenario, before] : logs.before) {
    std::vector<double> stratum = logs.after.at(scenario);
    for (std::size_t i = 0; i < stratum.size(); ++i) stratum[i] -= before[i];
    strata.push_back(std::move(stratum));
  }
  return strata;
}

PairedStrata values(const std::map<std::string, std::vector<double>>& by_scenario) {
  PairedStrata strata;
  for (const auto& [scenario, logs] : by_scenario) strata.push_back(logs);
  return strata;
}

double geometric_mean(const std::map<std::string, std::vector<double>>& by_scenario) {
  double sum = 0.0;
  for (const auto& [scenario, logs] : by_scenario) {
    double own = 0.0;
    for (const double value : logs) own += value;
    sum += own / static_cast<double>(logs.size());
  }
  return by_scenario.empty() ? 0.0 : std::exp(sum / static_cast<double>(by_scenario.size()));
}

double weight_of(const Change& change, std::size_t scenarios) {
  if (change.scenario.empty()) return change.figure->weight;
  return kScenarioShare * change.figure->weight / static_cast<double>(scenarios);
}

/// @param share  of the rate of false alarms that this test has to itself
double detectable(const PairedMean& mean, double standard_error, double effect_percent, double share) {
  const double effect = std::log1p(0.01 * effect_percent);
  const double critical = critical_value(mean, share);
  if (standard_error == 0.0) return std::isfinite(critical) ? effect_percent : critical;
  return percent_of(std::max(effect + kPower95 * standard_error, (critical + kPower95) * standard_error));
}

double total_weight(const std::vector<Change>& changes, std::size_t scenarios) {
  double total = kStatusWeight;
  for (const Change& change : changes) total += change.gated ? weight_of(change, scenarios) : 0.0;
  return total;
}

Change change_of(const std::vector<RunPair>& pairs, const RegressFigure& figure, const std::string& scenario) {
  const Logarithms logs = logarithms(pairs, figure, scenario);
  Change change;
  change.figure = &figure;
  change.scenario = scenario;
  change.before = geometric_mean(logs.before);
  change.after = geometric_mean(logs.after);
  return change;
}

std::vector<Change> changes_to_test(const std::vector<RunPair>& pairs, const std::vector<std::string>& scenarios,
                                    const Effects& effects, bool same_machine) {
  std::vector<Change> changes;
  for (const RegressFigure& figure : regress_figures()) changes.push_back(change_of(pairs, figure, {}));
  if (scenarios.size() > 1) {
    for (const RegressFigure& figure : regress_figures()) {
      if (!figure.by_scenario) continue;
      for (const std::string& scenario : scenarios) changes.push_back(change_of(pairs, figure, scenario));
    }
  }
  for (Change& change : changes) {
    change.effect_percent = effects.of(*change.figure);
    change.gated = same_machine || !change.figure->of_machine;
  }
  return changes;
}

StatusChange status_of(const std::vector<RunPair>& pairs) {
  StatusChange status;
  for (const RunPair& pair : pairs) {
    if (pair.before->is_ok() && !pair.after->is_ok()) status.newly_failing.push_back(pair);
    if (!pair.before->is_ok() && pair.after->is_ok()) status.newly_ok.push_back(pair);
  }
  const auto share = static_cast<std::size_t>(std::ceil(kLeastFailingShare * static_cast<double>(pairs.size())));
  status.least_failing = std::max(kLeastFailing, share);
  status.p_worse = sign_test(status.newly_failing.size(), status.newly_failing.size() + status.newly_ok.size());
  return status;
}

void judge(Comparison& comparison, std::size_t scenarios) {
  std::vector<Hypothesis> worse{{comparison.status.p_worse, kStatusWeight}};
  std::vector<Hypothesis> better;
  for (const Change& change : comparison.changes) {
    if (!change.gated) continue;
    worse.push_back({change.p_worse, weight_of(change, scenarios)});
    better.push_back({change.p_better, weight_of(change, scenarios)});
  }
  const std::vector<bool> is_worse = holm(worse, kFalseAlarmRate);
  const std::vector<bool> is_better = holm(better, kFalseAlarmRate);
  StatusChange& status = comparison.status;
  status.worse = is_worse[0] && status.newly_failing.size() >= status.newly_ok.size() + status.least_failing;
  std::size_t next = 0;
  for (Change& change : comparison.changes) {
    if (!change.gated) continue;
    const double factor = 1.0 + 0.01 * change.effect_percent;
    const double grown = 1.0 + 0.01 * change.percent.value;
    change.better = is_better[next] && grown < 1.0 / factor;
    change.worse = is_worse[++next] && grown > factor;
  }
}

std::string stream_of(const Change& change) { return "regress." + change.figure->key + "." + change.scenario; }

}  // namespace

bool Comparison::passes() const {
  return without_result.empty() && !status.worse &&
         std::none_of(changes.begin(), changes.end(), [](const Change& change) { return change.worse; });
}

std::vector<std::string> scenarios_of(const std::vector<RunPair>& pairs) {
  std::vector<std::string> names;
  for (const RunPair& pair : pairs) {
    if (names.empty() || names.back() != pair.before->scenario) names.push_back(pair.before->scenario);
  }
  return names;
}

Comparison compare_runs(const std::vector<MeasuredRun>& before, const std::vector<MeasuredRun>& after,
                        const Effects& effects, bool same_machine) {
  Comparison comparison;
  comparison.pairs = paired(before, after);
  const std::vector<std::string> scenarios = scenarios_of(comparison.pairs);
  comparison.changes = changes_to_test(comparison.pairs, scenarios, effects, same_machine);
  const double total = total_weight(comparison.changes, scenarios.size());
  for (Change& change : comparison.changes) {
    const Logarithms logs = logarithms(comparison.pairs, *change.figure, change.scenario);
    const PairedMean mean = paired_bootstrap(differences(logs), stream_of(change));
    const double share = kFalseAlarmRate * weight_of(change, scenarios.size()) / total;
    change.pairs = mean.pairs;
    change.percent = {percent_of(mean.mean.value), percent_of(mean.mean.low), percent_of(mean.mean.high)};
    change.p_worse = mean.p_above;
    change.p_better = mean.p_below;
    change.detectable_percent = detectable(mean, mean.standard_error, change.effect_percent, share);
  }
  for (const RunPair& pair : comparison.pairs) {
    if (pair.before->status != "error" && pair.after->status == "error") comparison.without_result.push_back(pair);
  }
  comparison.status = status_of(comparison.pairs);
  judge(comparison, scenarios.size());
  return comparison;
}

std::vector<double> detectable_unpaired_percent(const Comparison& comparison) {
  const std::size_t scenarios = scenarios_of(comparison.pairs).size();
  const double total = total_weight(comparison.changes, scenarios);
  std::vector<double> result;
  for (const Change& change : comparison.changes) {
    const Logarithms logs = logarithms(comparison.pairs, *change.figure, change.scenario);
    const PairedMean mean = paired_bootstrap(values(logs.before), stream_of(change));
    const double share = kFalseAlarmRate * weight_of(change, scenarios) / total;
    result.push_back(detectable(mean, std::sqrt(2.0) * mean.standard_error, change.effect_percent, share));
  }
  return result;
}

}  // namespace plumbline
