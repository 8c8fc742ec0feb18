#pragma once

#include <string>

#include "estimator/localization/prior_map.h"

namespace plumbline {

/// How one map lies on another where they overlap.
struct MapAlignment {
  Pose a_from_b;
  std::string refusal;       ///< empty: they go together; otherwise why not
  double overlap = 0.0;      ///< share of B's features with a surface of A nearby
  double close_share = 0.0;  ///< of those, the share that lies on A
  double support = 0.0;      ///< see map_support()
  double residual_median_m = 0.0;
  double residual_p95_m = 0.0;
  double correction_m = 0.0;  ///< of the guess, in the middle of the overlap
  double correction_rad = 0.0;
  double spread_m = 0.0;  ///< between alignments found from guesses to either side
  int well_conditioned = 0;
};

/// Aligns B with A by matching its surfaces with A's (thesis 8.2: the aerial map enters the ground map's frame), and
/// says whether the overlap bears it out.
/// @param guess  a_from_b to a metre and ten degrees: localization gives it, or a common start
MapAlignment align_maps(const PriorMap& a, const PriorMap& b, const Pose& guess);

}  // namespace plumbline
