#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "scenarios/run_record.h"

namespace plumbline {

/// How a run kept to its prior map.
struct LocalizationFigures {
  std::int64_t matches = 0;
  std::map<std::string, std::int64_t> outcomes;  ///< agreement -> count
  bool at_end = false;                           ///< localized at the last output
  std::optional<double> share;                   ///< of the outputs that are localized
  std::optional<double> first_s;                 ///< since the first output
  std::optional<std::int64_t> settled_ns;        ///< the output is on the map from then on
  /// Position error while localized, from when the first correction has been spent, after the one SE(3) that best fits
  /// those poses: where a map lies in the true world nobody knows.
  std::optional<double> error_median_m;
  std::optional<double> error_p75_m;
  std::optional<double> error_max_m;
  std::optional<double> overlap_median;
  std::optional<double> support_median;
  std::optional<double> correction_median_m;
  std::optional<double> iterations_median;
  std::optional<double> mean_ms;   ///< of a match, its stacking included
  std::optional<double> ms_per_s;  ///< the same per second of data
};

/// Nothing for a run without a map.
std::optional<LocalizationFigures> localization_figures(const RunRecord& record);

}  // namespace plumbline
