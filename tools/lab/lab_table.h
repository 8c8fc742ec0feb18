#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/degeneracy_lab.h"
#include "scenarios/image_truth.h"

namespace plumbline {

/// detectors.csv of a run: stamp_ns, excess_1 ... excess_6 (the bound's standard deviations over their limits, worst
/// first), degenerate (how many directions are), mean_range_m, for each detector its score and, where a direction is
/// degenerate, angle_deg, and error_over_selected, error_over_all.
std::string lab_csv(const std::vector<ScanTrial>& trials);

/// truth_degeneracy.csv of a run: stamp_ns, module, features (of images), degenerate, excess_1 ... excess_6. Scans are
/// stamped at their end, as the modules' own rows of degeneracy.csv are.
std::string truth_csv(const std::vector<ScanTrial>& scans, const std::vector<ImageTrial>& images);

/// mitigations.csv of a run: mitigation, drift_percent, progress_ratio, degenerate (how many scans were).
std::string mitigations_csv(const LabRun& lab);

struct MitigationRow {
  std::string mitigation;
  std::optional<double> drift_percent;
  std::optional<double> progress_ratio;
  int degenerate = 0;
};
/// @returns nothing where there is no such file, or it is not one of ours
std::vector<MitigationRow> read_mitigations_csv(const std::filesystem::path& path);

/// A row of detectors.csv, read back.
struct LabRow {
  double worst_excess = 0.0;
  int degenerate = 0;
  std::vector<double> scores;                     ///< as kDetectors
  std::vector<std::optional<double>> angles_deg;  ///< as kDetectors
  std::optional<double> error_over_selected;
  std::optional<double> error_over_all;
};

/// @returns nothing where there is no such file, or it is not one of ours
std::vector<LabRow> read_lab_csv(const std::filesystem::path& path);

}  // namespace plumbline
