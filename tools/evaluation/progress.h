#pragma once

#include <optional>
#include <vector>

#include "tools/evaluation/pairing.h"

namespace plumbline {

/// Estimated over true displacement along the true path's tangent. 1 is right; a frozen estimate gives 0 where an error
/// after alignment, or at the end of a loop, would hide it.
struct ProgressRatio {
  std::optional<double> whole;     ///< nothing for a truth that did not move
  std::optional<double> worst_5s;  ///< furthest from 1 of all 5 s windows with at least 1 m of true travel
};

/// @param aligned_pairs  estimates aligned to the first second
ProgressRatio progress_ratio(const std::vector<PosePair>& aligned_pairs);

}  // namespace plumbline
