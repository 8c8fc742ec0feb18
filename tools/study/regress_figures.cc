#include "tools/study/regress_figures.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

// Below these nothing matters, and logarithms of next to nothing would drown what does.
constexpr double kLeastError_mm = 0.01;
constexpr double kLeastRotation_mdeg = 0.1;
constexpr double kLeastDrift_percent = 0.02;
constexpr double kLeastProgressError_percent = 0.02;

/// The geometric mean over the run's seconds, in thousandths of their unit. A root mean square is that of the two or
/// three worst ones, which vary the most: on the kept bank (tests/proof) a growth of 8.6 % is 3.0 standard errors of a
/// suite of eight seeds by it, 3.9 by this.
std::optional<double> over_seconds(const std::vector<double>& errors, double least) {
  double sum = 0.0;
  int seconds = 0;
  for (const double error : errors) {
    if (!std::isfinite(error)) continue;
    sum += std::log(std::max(1e3 * error, least));
    ++seconds;
  }
  return seconds > 0 ? std::optional(std::exp(sum / seconds)) : std::nullopt;
}

std::optional<double> relative_error(const MeasuredRun& run) {
  return over_seconds(run.relative_error_by_second_m, kLeastError_mm);
}

std::optional<double> relative_rotation(const MeasuredRun& run) {
  return over_seconds(run.relative_rotation_by_second_deg, kLeastRotation_mdeg);
}

std::optional<double> drift(const MeasuredRun& run) {
  if (!run.drift_percent) return std::nullopt;
  return std::max(*run.drift_percent, kLeastDrift_percent);
}

std::optional<double> progress_error(const MeasuredRun& run) {
  if (!run.progress_ratio) return std::nullopt;
  return std::max(100.0 * std::abs(*run.progress_ratio - 1.0), kLeastProgressError_percent);
}

std::optional<double> positive(double value) { return value > 0.0 ? std::optional(value) : std::nullopt; }

}  // namespace

const std::vector<RegressFigure>& regress_figures() {
  // End points are one sample a run and vary by their own size; what else a machine does moves the times of all runs at
  // once, which no number of runs shows.
  static const std::vector<RegressFigure> figures{
      {"relative_error", "1 s relative error", "mm", 4.0, 8.0, true, false, relative_error},
      {"relative_rotation", "1 s rotation error", "mdeg", 4.0, 8.0, true, false, relative_rotation},
      {"drift", "End-point drift", "%", 40.0, 4.0, true, false, drift},
      {"progress", "Progress error", "%", 60.0, 1.0, false, false, progress_error},
      {"time", "Estimator time", "× simulation's", 35.0, 1.0, false, true,
       [](const MeasuredRun& run) { return positive(run.estimator_time_ratio.value_or(0.0)); }},
      {"memory", "Peak memory", "MB", 20.0, 1.0, false, true,
       [](const MeasuredRun& run) { return positive(run.peak_memory_mb); }},
  };
  return figures;
}

double Effects::of(const RegressFigure& figure) const {
  const auto found = percent.find(figure.key);
  return found == percent.end() ? figure.effect_percent : found->second;
}

}  // namespace plumbline
