#pragma once

#include <optional>
#include <vector>

#include "tools/evaluation/pairing.h"

/// Errors of an estimated trajectory. Every function takes pairs in time order, the estimate already aligned where it
/// says so, and gives nothing rather than a number without meaning.
namespace plumbline {

/// Length of the path through the poses [m].
double path_length_m(const StampedPoses& poses);

/// Path length from the first pair up to each pair's truth [m].
std::vector<double> distance_along(const std::vector<PosePair>& pairs);

/// Position error at the last pair as % of distance_m, estimate aligned to the first second: the thesis's "relative
/// position error". Nothing for a truth that did not move.
std::optional<double> drift_percent(const std::vector<PosePair>& aligned_pairs, double distance_m);

struct RootMeanSquare {
  double translation_m = 0.0;
  double rotation_deg = 0.0;
};

/// Of the poses, the estimate aligned by the caller. Nothing without pairs.
std::optional<RootMeanSquare> absolute_error(const std::vector<PosePair>& aligned_pairs);

/// Of the motions over 1 s; blind to alignment. Nothing when the pairs span less.
std::optional<RootMeanSquare> relative_error(const std::vector<PosePair>& pairs);

/// Of the motions over 1 s that begin in each second, counted from the first pair: a run's samples for statistics. A
/// second in which none begins is NaN.
std::vector<RootMeanSquare> relative_error_by_second(const std::vector<PosePair>& pairs);

}  // namespace plumbline
