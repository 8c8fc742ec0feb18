#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/measured_run.h"
#include "tools/study/paired_bootstrap.h"
#include "tools/study/regress_figures.h"

namespace plumbline {

/// The same scenario and seed run by two programs.
struct RunPair {
  const MeasuredRun* before = nullptr;
  const MeasuredRun* after = nullptr;
};

/// How one figure changed, over the whole suite or in one scenario. Ratios of runs are averaged as logarithms, every
/// scenario counting alike.
struct Change {
  const RegressFigure* figure = nullptr;
  std::string scenario;  ///< empty: the whole suite
  std::size_t pairs = 0;
  double before = 0.0;  ///< geometric mean
  double after = 0.0;
  Interval percent;  ///< growth, 95 %; unbounded where the pairs are too few to tell
  double effect_percent = 0.0;
  double p_worse = 1.0;
  double p_better = 1.0;
  /// Growth that is caught 19 times in 20 with pairs that scatter as these do; infinite: with pairs so few, none.
  double detectable_percent = 0.0;
  bool gated = true;  ///< otherwise only shown
  bool worse = false;
  bool better = false;
};

/// Runs that were ok and are not, against those that were not and are.
struct StatusChange {
  std::vector<RunPair> newly_failing;
  std::vector<RunPair> newly_ok;
  std::size_t least_failing = 0;  ///< fewer never fail the gate
  double p_worse = 1.0;
  bool worse = false;
};

struct Comparison {
  std::vector<RunPair> pairs;
  std::vector<Change> changes;  ///< of the whole suite by figure, then by figure and scenario
  StatusChange status;
  /// Runs that had a result and have none now: a crash or a hang is no matter of chance.
  std::vector<RunPair> without_result;

  bool passes() const;
};

/// Names in order.
std::vector<std::string> scenarios_of(const std::vector<RunPair>& pairs);

/// The probability that any test at all fails where nothing has changed, at most; shared out by the figures' weights.
constexpr double kFalseAlarmRate = 0.005;

/// @param before, after  by scenario and seed; they must outlive the result, which points at them. Runs that only one
/// of them has are left out
/// @param same_machine   otherwise the machine's figures are only shown
Comparison compare_runs(const std::vector<MeasuredRun>& before, const std::vector<MeasuredRun>& after,
                        const Effects& effects, bool same_machine);

/// What growth of each of comparison.changes would be caught 19 times in 20 if the seeds of the two were not even the
/// same: from the scatter of the runs before. What pairing gains is the rest to detectable_percent.
std::vector<double> detectable_unpaired_percent(const Comparison& comparison);

}  // namespace plumbline
