#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/study/sweep_plan.h"

namespace plumbline {

/// An axis cut into few settings for charts: its own values where they are few, else equal stretches of its range.
struct AxisBins {
  struct Bin {
    double place = 0.0;  ///< on the chart's axis: the value (its logarithm on logarithmic axes), or just its number
    std::string label;
  };
  std::size_t axis = 0;
  std::string key;
  bool numeric = false;
  std::vector<Bin> bins;
  std::vector<std::size_t> bin_of_run;  ///< per run of the plan
};

AxisBins bin_axis(const SweepPlan& plan, std::size_t axis);

}  // namespace plumbline
