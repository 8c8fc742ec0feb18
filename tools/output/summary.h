#pragma once

#include <string>

#include "scenarios/run_record.h"
#include "tools/evaluation/figures.h"
#include "tools/evaluation/verdict.h"

/// Figures for people, on a terminal.
namespace plumbline {

/// "drift  0.31 %" and so on, a line each.
std::string trajectory_summary(const TrajectoryFigures& figures);

/// The main figures of a run and everything that did not hold.
std::string run_summary(const RunRecord& record, const RunFigures& figures, const Verdict& verdict);

}  // namespace plumbline
