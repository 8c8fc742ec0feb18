#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/lab/detector_scores.h"
#include "tools/report/drawing.h"
#include "tools/study/sweep_plan.h"

namespace plumbline {

/// What a sweep with `detectors:` found out about them.
struct LabFindings {
  std::vector<DetectorScore> detectors;  ///< those the plan names
  RegistrationEfficiency registration;
};

/// Reads runs/KEY/detectors.csv of every run that wrote one.
LabFindings lab_findings(const SweepPlan& plan, const std::filesystem::path& root);

/// detectors.csv of a sweep, a row per detector: scans of each kind, area, recommended threshold with margin, hits and
/// false alarms there, angle, latency; and as the row "registration" its efficiency.
std::string detectors_csv(const LabFindings& findings);

/// The section of the sweep's page. @param charts  gets the charts it draws
std::string lab_section(const LabFindings& findings, std::vector<Drawing>& charts);

}  // namespace plumbline
