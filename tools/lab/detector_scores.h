#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/lab/lab_table.h"

namespace plumbline {

/// Where a detector's threshold could be, and what it would do there.
struct RocPoint {
  double threshold = 0.0;
  double false_alarms = 0.0;  ///< share of well-determined scans below it
  double hits = 0.0;          ///< share of degenerate scans below it
};

/// The threshold that separates best: at the geometric middle of the widest gap among the equally good.
struct ThresholdChoice {
  RocPoint at;
  /// The factor by which scores may be off, either way, before another scan falls on the wrong side; 1 without a gap.
  double margin = 1.0;
};

/// How well a detector tells degenerate scans from well-determined ones. Scans in the grey zone count for neither.
struct DetectorScore {
  std::string name;
  std::size_t degenerate = 0;
  std::size_t well = 0;
  std::size_t grey = 0;
  std::optional<double> area;             ///< under the ROC curve; nothing without scans of both kinds
  std::vector<RocPoint> roc;              ///< by falling threshold
  std::optional<ThresholdChoice> choice;  ///< nothing without scans of both kinds
  std::optional<RocPoint> in_use;         ///< of D only: at the threshold by which scan matching remaps
  std::optional<double> angle_deg;        ///< median over degenerate scans
  std::optional<double> latency_scans;    ///< median over onsets of degeneracy until it is reported, at that threshold
  std::size_t onsets = 0;
  std::size_t onsets_missed = 0;  ///< over before it was reported; their length counts as the latency
};

/// @param detector  index into kDetectors
/// @param runs  the scans of each run in time order
DetectorScore score_detector(std::size_t detector, const std::vector<std::vector<LabRow>>& runs);

/// Registration on the true surfaces over the Cramer-Rao bound: root mean square over the well-determined scans.
struct RegistrationEfficiency {
  std::size_t scans = 0;
  std::optional<double> over_selected;  ///< of the points it selected
  std::optional<double> over_all;       ///< of all returns
};
RegistrationEfficiency registration_efficiency(const std::vector<std::vector<LabRow>>& runs);

}  // namespace plumbline
