#pragma once

#include <string>
#include <vector>

#include "tools/lab/lab_report.h"
#include "tools/report/drawing.h"
#include "tools/study/run_rows.h"

namespace plumbline {

/// A sweep's page, and its charts for files of their own.
struct SweepReport {
  std::string html;  ///< one page that needs nothing but the runs' own pages it links to, at runs/KEY/report.html
  std::vector<Drawing> charts;
};

/// @param rows  those that have ended, by key
/// @param lab  of a plan with detectors
SweepReport sweep_report(const SweepPlan& plan, const std::vector<RunRow>& rows, const LabFindings& lab = {});

}  // namespace plumbline
