#pragma once

#include <string>

#include "tools/report/regression.h"

/// A regression told to machines and to pull requests.
namespace plumbline {

/// JUnit's XML: a test suite per figure with a test case per scenario, and one of the runs with a case each.
std::string regress_junit(const Regression& regression);

/// Markdown for a pull request: the verdict, a table of the figures, what is detectable, the scenarios folded away.
std::string regress_markdown(const Regression& regression);

}  // namespace plumbline
