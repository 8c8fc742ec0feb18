#include "tools/thesis/judgement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/evaluation/quantile.h"
#include "tools/formats/number_text.h"
#include "tools/study/statistics.h"

namespace plumbline {
namespace {

using Runs = std::vector<std::vector<std::optional<RunRow>>>;

/// Routes begin and end a little inside their scenes.
constexpr double kSameLength = 0.97;

std::string unit_of(const std::string& figure) {
  if (figure.ends_with("_percent")) return " %";
  if (figure.ends_with("deg_per_m")) return " °/m";
  if (figure.ends_with("_deg")) return "°";
  if (figure.ends_with("_m")) return " m";
  if (figure.ends_with("_s")) return " s";
  return {};
}

std::string with_unit(double value, const std::string& figure) { return readable_text(value) + unit_of(figure); }

/// The figures of one configuration's runs, missing ones as NaN; nothing while a run has not ended.
std::optional<std::vector<double>> figures_of(const std::vector<std::optional<RunRow>>& runs,
                                              const std::string& figure) {
  std::vector<double> values;
  for (const auto& run : runs) {
    if (!run) return std::nullopt;
    values.push_back(run->figure(figure).value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return values;
}

std::size_t without_figure(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }));
}

void append(std::string& text, const std::string& more, const std::string& between = ", ") {
  text += (text.empty() ? "" : between) + more;
}

/// Judges one check of an experiment.
class CheckJudge {
 public:
  CheckJudge(const Experiment& experiment, const Runs& runs, const ExperimentCheck& check)
      : experiment_(experiment), runs_(runs), check_(check) {}

  CheckOutcome outcome() {
    outcome_.check = describe(check_);
    if (check_.kind == ExperimentCheck::Kind::kOk) {
      judge_ok();
    } else if (collect()) {
      judge_figures();
    }
    return outcome_;
  }

 private:
  const std::vector<std::optional<RunRow>>& runs_of(const std::string& configuration) const {
    return runs_[experiment_.index_of(configuration)];
  }

  /// A failure decides a share of 1 as soon as it is there.
  void judge_ok() {
    outcome_.holds = true;
    bool all_ended = true;
    for (const std::string& configuration : check_.configurations) {
      const auto& runs = runs_of(configuration);
      std::size_t ended = 0;
      std::size_t ok = 0;
      for (const auto& run : runs) {
        if (!run) continue;
        ++ended;
        ok += run->is_ok() ? 1U : 0U;
      }
      append(outcome_.measured, configuration + " " + std::to_string(ok) + " of " + std::to_string(ended));
      all_ended = all_ended && ended == runs.size();
      const auto best = static_cast<double>(ok + runs.size() - ended) / static_cast<double>(runs.size());
      if (best < *check_.min) outcome_.holds = false;
    }
    if (*outcome_.holds && !all_ended) outcome_.holds = std::nullopt;
  }

  /// @returns whether there is a median for each configuration
  bool collect() {
    for (const std::string& configuration : check_.configurations) {
      const auto values = figures_of(runs_of(configuration), check_.figure);
      if (!values) return false;
      if (const std::size_t missing = without_figure(*values)) {
        outcome_.holds = false;
        append(outcome_.measured, configuration + ": " + std::to_string(missing) + " of " +
                                      std::to_string(values->size()) + " runs without this figure");
      }
      values_.push_back(*values);
    }
    if (outcome_.holds) return false;
    for (const auto& values : values_) medians_.push_back(*quantile(values, 0.5));
    return true;
  }

  bool within(double value) const { return value >= check_.min.value_or(value) && value <= check_.max.value_or(value); }

  void judge_figures() {
    switch (check_.kind) {
      case ExperimentCheck::Kind::kBound:
        outcome_.holds = std::all_of(medians_.begin(), medians_.end(), [&](double m) { return within(m); });
        return tell_medians();
      case ExperimentCheck::Kind::kRising:
        outcome_.holds = std::is_sorted(medians_.begin(), medians_.end());
        return tell_medians();
      case ExperimentCheck::Kind::kOrder:
        tell_medians();
        return judge_order();
      case ExperimentCheck::Kind::kRatio:
        return judge_ratio();
      case ExperimentCheck::Kind::kOk:
        return;
    }
  }

  void tell_medians() {
    for (std::size_t i = 0; i < medians_.size(); ++i) {
      append(outcome_.measured, check_.configurations[i] + " " + with_unit(medians_[i], check_.figure));
    }
  }

  /// Runs of one seed share their world and their noise, so gaps are taken seed by seed.
  void judge_order() {
    outcome_.holds = std::is_sorted(medians_.begin(), medians_.end());
    for (std::size_t i = 1; i < values_.size(); ++i) {
      std::vector<double> gaps;
      for (std::size_t s = 0; s < values_[i].size(); ++s) gaps.push_back(values_[i][s] - values_[i - 1][s]);
      const Interval gap = *bootstrap_median(gaps, "thesis.order");
      append(outcome_.measured,
             "gap " + readable_text(gap.value) + " (" + readable_text(gap.low) + " … " + readable_text(gap.high) + ")",
             "; ");
      if (gap.low <= 0.0) outcome_.holds = false;
    }
  }

  void judge_ratio() {
    std::vector<double> ratios;
    for (std::size_t s = 0; s < values_[0].size(); ++s) ratios.push_back(values_[0][s] / values_[1][s]);
    const bool finite = std::all_of(ratios.begin(), ratios.end(), [](double ratio) { return std::isfinite(ratio); });
    if (!finite) {
      outcome_.holds = false;
      outcome_.measured = "no ratio: " + check_.configurations[1] + " is zero";
      return;
    }
    const Interval ratio = *bootstrap_median(ratios, "thesis.ratio");
    outcome_.holds = within(ratio.value);
    outcome_.measured =
        readable_text(ratio.value) + " (" + readable_text(ratio.low) + " … " + readable_text(ratio.high) + ")";
  }

  const Experiment& experiment_;
  const Runs& runs_;
  const ExperimentCheck& check_;
  CheckOutcome outcome_;
  std::vector<std::vector<double>> values_;  ///< of each of the check's configurations
  std::vector<double> medians_;
};

std::size_t seeds_run(const Experiment& experiment, const Runs& runs) {
  std::size_t count = 0;
  for (std::size_t s = 0; s < experiment.seeds.size(); ++s) {
    count += std::all_of(runs.begin(), runs.end(), [&](const auto& of) { return of[s].has_value(); }) ? 1U : 0U;
  }
  return count;
}

void tell_figures(const Experiment& experiment, const Runs& runs, Judgement& judgement) {
  const bool named = experiment.configurations.size() > 1;
  for (std::size_t c = 0; c < runs.size(); ++c) {
    const std::string& name = experiment.configurations[c].name;
    ConfigurationFigures figures{name, {}};
    for (const auto& run : runs[c]) {
      if (const auto value = run ? run->figure(experiment.figure) : std::nullopt) figures.values.push_back(*value);
    }
    if (!figures.values.empty()) {
      const auto [low, high] = std::minmax_element(figures.values.begin(), figures.values.end());
      const std::string prefix = named ? name + " " : "";
      append(judgement.ours, prefix + with_unit(*quantile(figures.values, 0.5), experiment.figure));
      append(judgement.spread, prefix + readable_text(*low) + " … " + with_unit(*high, experiment.figure));
    }
    judgement.figures.push_back(std::move(figures));
  }
}

std::string failures_note(const Experiment& experiment, const Runs& runs) {
  std::string note;
  for (std::size_t c = 0; c < runs.size(); ++c) {
    std::size_t ended = 0;
    std::vector<std::string> failed;
    for (std::size_t s = 0; s < runs[c].size(); ++s) {
      if (!runs[c][s]) continue;
      ++ended;
      const RunRow& run = *runs[c][s];
      if (run.is_ok()) continue;
      failed.push_back("seed " + std::to_string(experiment.seeds[s]) + " " +
                       (run.outcome == "finished" ? run.status : run.outcome));
    }
    if (failed.empty()) continue;
    std::string text = experiment.configurations[c].name + ": " + std::to_string(failed.size()) + " of " +
                       std::to_string(ended) + " not ok (";
    for (std::size_t i = 0; i < failed.size(); ++i) text += (i == 0 ? "" : ", ") + failed[i];
    append(note, text + ")", "; ");
  }
  return note;
}

/// The path, where it is shorter than the thesis's.
std::optional<double> shorter_path_m(const Experiment& experiment, const Runs& runs) {
  if (!experiment.length_m) return std::nullopt;
  std::vector<double> lengths;
  for (const auto& of_configuration : runs) {
    for (const auto& run : of_configuration) {
      if (const auto length = run ? run->figure("distance_m") : std::nullopt) lengths.push_back(*length);
    }
  }
  const auto shortest = std::min_element(lengths.begin(), lengths.end());
  if (shortest == lengths.end() || *shortest >= kSameLength * *experiment.length_m) return std::nullopt;
  return *shortest;
}

}  // namespace

Judgement judge(const Experiment& experiment, const Runs& runs) {
  Judgement judgement;
  judgement.seeds = seeds_run(experiment, runs);
  tell_figures(experiment, runs, judgement);
  bool broken = false;
  bool open = false;
  for (const ExperimentCheck& check : experiment.checks) {
    judgement.checks.push_back(CheckJudge(experiment, runs, check).outcome());
    const auto& holds = judgement.checks.back().holds;
    broken = broken || (holds && !*holds);
    open = open || !holds;
  }
  const auto shorter_m = shorter_path_m(experiment, runs);
  if (broken) {
    judgement.holds = false;
  } else if (!open && !shorter_m) {
    judgement.holds = true;
  }
  judgement.note = failures_note(experiment, runs);
  if (shorter_m) {
    append(judgement.note,
           "run over " + readable_text(*shorter_m) + " m of the thesis's " + readable_text(*experiment.length_m) +
               " m, which does not count as holding",
           "; ");
  }
  const bool begun = std::any_of(judgement.figures.begin(), judgement.figures.end(),
                                 [](const ConfigurationFigures& figures) { return !figures.values.empty(); });
  if (begun && judgement.seeds < experiment.seeds.size()) {
    append(judgement.note,
           std::to_string(judgement.seeds) + " of " + std::to_string(experiment.seeds.size()) + " seeds run", "; ");
  }
  return judgement;
}

}  // namespace plumbline
