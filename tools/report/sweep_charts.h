#pragma once

#include <vector>

#include "tools/report/drawing.h"
#include "tools/study/axis_bins.h"
#include "tools/study/run_rows.h"

/// The charts of a sweep's report.
namespace plumbline {

/// What the charts are drawn from; everything outlives the calls.
struct SweepView {
  SweepView(const SweepPlan& plan, const std::vector<RunRow>& rows);

  const SweepPlan& plan;
  const std::vector<RunRow>& rows;  ///< by key
  std::vector<AxisBins> axes;       ///< those that have more than one setting

  /// The setting of a row on an axis.
  std::size_t bin(const AxisBins& axis, const RunRow& row) const;
};

/// Success rate with Wilson's interval over each axis, a series per estimator, and over each pair of axes.
std::vector<Drawing> success_charts(const SweepView& view);

/// Median drift with its bootstrap interval over each axis, a series per estimator, and over each pair of axes. Runs
/// without a drift are left out: their failure shows in the success rates.
std::vector<Drawing> drift_charts(const SweepView& view);

/// How much of the time each module was degenerate, over each axis.
std::vector<Drawing> degeneracy_charts(const SweepView& view);

/// The fitted success curve of each boundary that was searched for, with what the runs gave.
std::vector<Drawing> boundary_charts(const SweepView& view);

}  // namespace plumbline
