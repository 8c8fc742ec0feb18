#pragma once

#include <string>
#include <vector>

#include "tools/study/run_rows.h"

/// The tables of a sweep's page.
namespace plumbline {

/// Success, drift and degenerate share of each estimator, and each against the first.
std::string estimator_table(const SweepPlan& plan, const std::vector<RunRow>& rows);

/// Runs that are not ok, worst first.
std::string failure_table(const SweepPlan& plan, const std::vector<RunRow>& rows);

/// Every run, folded away.
std::string run_table(const SweepPlan& plan, const std::vector<RunRow>& rows);

/// Where each boundary was found; for plans with one to find.
std::string boundary_table(const SweepPlan& plan, const std::vector<RunRow>& rows);

/// What the sweep was asked to do.
std::string origin_table(const SweepPlan& plan);

}  // namespace plumbline
