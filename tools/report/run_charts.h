#pragma once

#include <string>

#include "scenarios/run_record.h"
#include "tools/evaluation/figures.h"

/// The plots of a run's report, each a figure or several as HTML.
namespace plumbline {

/// The truth's first stamp, or the estimate's where there is no truth; charts count from it.
std::int64_t start_of(const RunRecord& record);

/// Position error along the true body's axes, and attitude error about them, over time.
std::string error_charts(const RunRecord& record, const TrajectoryFigures& figures);

/// How well each stack lay on the prior map, and how far it moved the estimate.
std::string localization_charts(const RunRecord& record);

/// The errors of a flight in closed loop, and how near things were.
std::string flight_charts(const RunRecord& record);

/// The eigenvalues of one module's data, degenerate directions marked; empty for a module without solves.
std::string eigenvalue_chart(const RunRecord& record, Module module, const std::string& caption);

/// What scan matching changed of its prediction on six axes, with the modules' status beneath.
std::string correction_charts(const RunRecord& record);

/// Mean and 95th percentile of the time per message.
std::string timing_chart(const RunFigures& figures);

}  // namespace plumbline
