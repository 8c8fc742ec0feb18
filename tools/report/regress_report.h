#pragma once

#include <string>
#include <vector>

#include "tools/report/drawing.h"
#include "tools/report/regression.h"

namespace plumbline {

/// A regression's page, and its charts for files of their own.
struct RegressReport {
  std::string html;  ///< one page that needs nothing but the runs' own pages it links to
  std::vector<Drawing> charts;
};

RegressReport regress_report(const Regression& regression);

}  // namespace plumbline
