#pragma once

#include <string>
#include <vector>

#include "tools/study/boundary_search.h"
#include "tools/study/run_rows.h"

namespace plumbline {

/// The runs over which one boundary is sought: all that differ in nothing but the axis's value and the seed.
struct BoundaryCurve {
  std::string label;                           ///< "world.fog.visibility_m = 20, vloam": what they have in common
  std::vector<double> positions;               ///< of the axis's values, in [0, 1]
  std::vector<std::vector<std::string>> keys;  ///< [value][seed]: the run
};

/// One per combination of the other axes and the estimators, in the plan's order.
/// @param plan  with a boundary to find
std::vector<BoundaryCurve> boundary_curves(const SweepPlan& plan);

/// The axis's value at a share of its way, and a share's value: logarithmic axes are walked in decades.
double share_of_value(const SweepAxis& axis, double value);
double value_of_share(const SweepAxis& axis, double share);

/// A search that has been told of every run it asked for and got, batch by batch, and what it would do next.
struct ReplayedSearch {
  BoundarySearch search;
  std::vector<std::string> next;  ///< runs of the batch that is due and not yet there
};
ReplayedSearch replay(const BoundaryCurve& curve, const std::vector<RunRow>& rows);

/// boundary.csv: a row per curve: the common part, the axis, boundary, low, high (95 %, in the axis's unit),
/// probability_inside, probability_falling, runs made, runs of the whole grid.
std::string boundary_csv(const SweepPlan& plan, const std::vector<RunRow>& rows);

}  // namespace plumbline
