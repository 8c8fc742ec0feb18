#pragma once

#include <string>

#include "tools/study/suite_file.h"
#include "tools/study/sweep_runner.h"

namespace plumbline {

/// A suite's runs as a sweep over its scenarios, so that what makes, stores, resumes and tabulates a sweep's runs does
/// so for a suite's.
/// @param estimator  instead of the scenarios' own; empty: their own
/// @throws InputError for a scenario or key that is refused
SweepPlan suite_plan(const SuiteFile& suite, const std::string& estimator);

/// Whether a plan is a suite's.
bool is_suite_plan(const SweepPlan& plan);

/// The name in its suite of what a run runs.
const std::string& suite_scenario_of(const PlannedRun& run);

/// `plumbline run` of one run, on one thread.
RunCommand suite_run(const SuiteFile& suite, const std::string& estimator, const std::string& program);

/// Tells suites apart whose runs cannot be compared: by name, resolved keys and seeds of every scenario, not by the
/// estimator.
std::string suite_digest(const SuiteFile& suite);

}  // namespace plumbline
