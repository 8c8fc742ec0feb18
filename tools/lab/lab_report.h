#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/lab/detector_scores.h"
#include "tools/report/drawing.h"
#include "tools/study/sweep_plan.h"

namespace plumbline {

/// What a mitigation does to scan matching on its own, over the runs with degenerate scans and over those without.
struct MitigationFigures {
  std::string mitigation;
  std::size_t degenerate_runs = 0;
  std::optional<double> degenerate_drift_percent;  ///< median
  std::optional<double> degenerate_progress;       ///< median progress ratio
  std::size_t well_runs = 0;
  std::optional<double> well_drift_percent;
  std::optional<double> well_progress;
};

/// What a sweep with `detectors:` found out about them.
struct LabFindings {
  std::vector<DetectorScore> detectors;  ///< those the plan names
  RegistrationEfficiency registration;
  std::vector<MitigationFigures> mitigations;
};

/// Reads runs/KEY/detectors.csv and mitigations.csv of every run that wrote them.
LabFindings lab_findings(const SweepPlan& plan, const std::filesystem::path& root);

/// detectors.csv of a sweep, a row per detector: scans of each kind, area, recommended threshold with margin, hits and
/// false alarms there, angle, latency; and as the row "registration" its efficiency.
std::string detectors_csv(const LabFindings& findings);

/// mitigations.csv of a sweep, a row per mitigation: medians over the runs with degenerate scans, and without.
std::string mitigations_csv(const LabFindings& findings);

/// The section of the sweep's page. @param charts  gets the charts it draws
std::string lab_section(const LabFindings& findings, std::vector<Drawing>& charts);

}  // namespace plumbline
