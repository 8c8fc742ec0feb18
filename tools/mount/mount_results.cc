#include "tools/mount/mount_results.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/evaluation/quantile.h"
#include "tools/formats/number_text.h"
#include "tools/study/rank_correlation.h"

namespace plumbline {
namespace {

// A run that was lost, or crashed, drifts at least this much: no figure of its own says how bad it was.
constexpr double kLostDrift_percent = 100.0;
// Drift compares by its logarithm; nothing is measured better than this.
constexpr double kLeastDrift_percent = 1e-3;

double log_drift(double percent) { return std::log(std::max(percent, kLeastDrift_percent)); }

/// Figures of which less is better; those without weight are left out.
std::vector<double> figures_of(const Mounting& mounting, const MountWeights& weights) {
  const bool measured = mounting.drift_percent.has_value();
  std::vector<double> figures;
  if (weights.drift > 0.0) {
    figures.push_back(log_drift(measured ? mounting.drift_percent->value : mounting.predicted.drift_percent));
  }
  if (weights.worst_direction > 0.0) figures.push_back(std::log(std::max(mounting.predicted.worst_direction, 1e-6)));
  if (weights.coverage > 0.0) figures.push_back(-mounting.predicted.coverage);
  if (weights.degenerate_time > 0.0) {
    figures.push_back(measured ? mounting.degenerate_time : mounting.predicted.degenerate_time);
  }
  return figures;
}

std::vector<double> weights_in_use(const MountWeights& weights) {
  std::vector<double> used;
  for (const double weight : {weights.drift, weights.worst_direction, weights.coverage, weights.degenerate_time}) {
    if (weight > 0.0) used.push_back(weight);
  }
  return used;
}

/// The weighted mean of the figures scaled to [0, 1] over those mountings.
std::vector<double> costs_of(const std::vector<const Mounting*>& mountings, const MountWeights& weights) {
  const std::vector<double> weight = weights_in_use(weights);
  const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
  std::vector<double> costs(mountings.size(), 0.0);
  for (std::size_t f = 0; f < weight.size(); ++f) {
    std::vector<double> values;
    for (const Mounting* mounting : mountings) values.push_back(figures_of(*mounting, weights)[f]);
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (*high <= *low) continue;
    for (std::size_t i = 0; i < values.size(); ++i) {
      costs[i] += weight[f] / total * (values[i] - *low) / (*high - *low);
    }
  }
  return costs;
}

bool dominates(const std::vector<double>& a, const std::vector<double>& b) {
  bool better = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] > b[i]) return false;
    better = better || a[i] < b[i];
  }
  return better;
}

void mark_front(std::vector<Mounting>& mountings, const MountWeights& weights, bool tried_only) {
  const auto counts = [&](const Mounting& m) { return m.ruled_out.empty() && (!tried_only || m.tried); };
  for (Mounting& mounting : mountings) {
    mounting.is_on_front =
        counts(mounting) && std::none_of(mountings.begin(), mountings.end(), [&](const Mounting& other) {
          return counts(other) && dominates(figures_of(other, weights), figures_of(mounting, weights));
        });
  }
}

double drift_of(const RunRow& row) {
  const double drift = row.figure("drift_percent").value_or(kLostDrift_percent);
  const bool is_lost = row.status == "lost" || row.status == "error";
  return is_lost ? std::max(drift, kLostDrift_percent) : drift;
}

/// Per seed, the geometric mean over scenarios of one estimator's drift.
std::vector<double> drifts_by_seed(const std::vector<const RunRow*>& rows, const std::string& estimator) {
  std::map<std::uint64_t, std::vector<double>> logs;
  for (const RunRow* row : rows) {
    if (row->run.estimator == estimator) logs[row->run.seed].push_back(log_drift(drift_of(*row)));
  }
  std::vector<double> drifts;
  for (const auto& [seed, of_seed] : logs) {
    drifts.push_back(
        std::exp(std::accumulate(of_seed.begin(), of_seed.end(), 0.0) / static_cast<double>(of_seed.size())));
  }
  return drifts;
}

std::vector<const RunRow*> rows_of(const Mounting& mounting,
                                   const std::vector<std::vector<RunRow>>& rows_of_scenarios) {
  std::vector<const RunRow*> found;
  for (const std::vector<RunRow>& rows : rows_of_scenarios) {
    for (const RunRow& row : rows) {
      const bool is_this =
          std::equal(row.run.values.begin(), row.run.values.end(), mounting.values.begin(), mounting.values.end(),
                     [](const AxisValue& a, const AxisValue& b) { return a.text == b.text; });
      if (is_this) found.push_back(&row);
    }
  }
  return found;
}

void take_runs(const MountStudy& study, const std::vector<std::vector<RunRow>>& rows_of_scenarios, Mounting& mounting) {
  const std::vector<const RunRow*> rows = rows_of(mounting, rows_of_scenarios);
  std::vector<double> degenerate;
  for (const RunRow* row : rows) {
    if (row->run.estimator != study.judged) continue;
    ++mounting.runs;
    mounting.lost += row->is_ok() ? 0 : 1;
    if (const auto share = row->figure("modules.lidar.degenerate_share")) degenerate.push_back(*share);
  }
  mounting.tried = mounting.runs > 0;
  mounting.drifts_percent = drifts_by_seed(rows, study.judged);
  mounting.drift_percent = bootstrap_median(mounting.drifts_percent, "mount.drift");
  for (const std::string& estimator : study.runs.estimators) {
    if (estimator == study.judged) continue;
    const auto drift = bootstrap_median(drifts_by_seed(rows, estimator), "mount.drift");
    if (drift) mounting.drift_of_others[estimator] = *drift;
  }
  if (!degenerate.empty()) {
    mounting.degenerate_time =
        std::accumulate(degenerate.begin(), degenerate.end(), 0.0) / static_cast<double>(degenerate.size());
  }
}

}  // namespace

std::string describe(const MountStudy& study, const Mounting& mounting) {
  std::string text;
  for (std::size_t a = 0; a < study.runs.axes.size(); ++a) {
    text += (text.empty() ? "" : ", ") + study.runs.axes[a].key + " = " + mounting.values[a].text;
  }
  return text;
}

MountPrediction combined(const std::vector<MountPrediction>& of_scenarios) {
  MountPrediction all;
  const double share = 1.0 / static_cast<double>(of_scenarios.size());
  double log_sum = 0.0;
  all.overlap = 1.0;
  for (const MountPrediction& one : of_scenarios) {
    log_sum += share * std::log(std::max(one.drift_percent, 1e-9));
    all.worst_direction = std::max(all.worst_direction, one.worst_direction);
    all.degenerate_time += share * one.degenerate_time;
    all.coverage += share * one.coverage;
    all.own_body_share = std::max(all.own_body_share, one.own_body_share);
    all.overlap = std::min(all.overlap, one.overlap);
  }
  all.drift_percent = std::exp(log_sum);
  return all;
}

std::string broken_limit(const MountPrediction& prediction, const MountLimits& limits) {
  if (prediction.own_body_share > limits.own_body_share) {
    return "the vehicle takes up " + readable_text(100.0 * prediction.own_body_share) + " % of the view";
  }
  if (prediction.overlap < limits.overlap) {
    return "the lidar sees " + readable_text(100.0 * prediction.overlap) + " % of the image";
  }
  return {};
}

std::vector<std::size_t> choose_for_trial(const MountStudy& study, std::vector<Mounting>& mountings) {
  std::vector<std::size_t> allowed;
  std::vector<const Mounting*> within;
  for (std::size_t i = 0; i < mountings.size(); ++i) {
    if (!mountings[i].ruled_out.empty()) continue;
    allowed.push_back(i);
    within.push_back(&mountings[i]);
  }
  if (allowed.empty()) return {};
  const std::vector<double> costs = costs_of(within, study.weights);
  for (std::size_t k = 0; k < allowed.size(); ++k) mountings[allowed[k]].predicted_cost = costs[k];
  mark_front(mountings, study.weights, /*tried_only=*/false);
  std::stable_sort(allowed.begin(), allowed.end(), [&](std::size_t a, std::size_t b) {
    return study.trial.spread ? mountings[a].predicted.drift_percent < mountings[b].predicted.drift_percent
                              : mountings[a].predicted_cost < mountings[b].predicted_cost;
  });
  const std::size_t count = std::min(allowed.size(), static_cast<std::size_t>(study.trial.mountings));
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t place = study.trial.spread && count > 1 ? k * (allowed.size() - 1) / (count - 1) : k;
    chosen.push_back(allowed[place]);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

MountResults conclude(const MountStudy& study, std::vector<Mounting> mountings,
                      const std::vector<std::vector<RunRow>>& rows_of_scenarios) {
  MountResults results;
  std::vector<const Mounting*> tried;
  std::vector<std::size_t> tried_at;
  for (std::size_t i = 0; i < mountings.size(); ++i) {
    take_runs(study, rows_of_scenarios, mountings[i]);
    if (!mountings[i].tried) continue;
    tried.push_back(&mountings[i]);
    tried_at.push_back(i);
  }
  if (!tried.empty()) {
    const std::vector<double> costs = costs_of(tried, study.weights);
    for (std::size_t k = 0; k < tried.size(); ++k) mountings[tried_at[k]].cost = costs[k];
    mark_front(mountings, study.weights, /*tried_only=*/true);
    results.recommended = *std::min_element(tried_at.begin(), tried_at.end(), [&](std::size_t a, std::size_t b) {
      return mountings[a].cost < mountings[b].cost;
    });
    std::vector<double> predicted;
    std::vector<double> measured;
    std::vector<std::vector<double>> samples;
    for (const Mounting* mounting : tried) {
      predicted.push_back(mounting->predicted.drift_percent);
      measured.push_back(mounting->drift_percent->value);
      samples.push_back(mounting->drifts_percent);
    }
    results.rank_correlation = bootstrap_spearman(predicted, measured, "mount.rank");
    results.ceiling = split_half_ceiling(samples, "mount.ceiling");
  }
  results.mountings = std::move(mountings);
  return results;
}

}  // namespace plumbline
