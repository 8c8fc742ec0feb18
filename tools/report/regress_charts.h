#pragma once

#include <vector>

#include "tools/report/drawing.h"
#include "tools/report/regression.h"

/// The charts of a regression's page.
namespace plumbline {

/// Growth with its 95 % interval in each scenario, of every figure that is tested there.
std::vector<Drawing> growth_charts(const Regression& regression);

/// Median over the seeds with its bootstrap interval in each scenario, before and after, of every figure.
std::vector<Drawing> before_after_charts(const Regression& regression);

/// The 1 s relative error along each scenario, root mean square over the seeds, before and after, as figures of a page.
std::string error_over_time_charts(const Regression& regression);

}  // namespace plumbline
