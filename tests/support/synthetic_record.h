#pragma once

#include <functional>

#include "scenarios/run_record.h"

namespace plumbline::testing {

/// Poses at 200 Hz over a time, as a function of it.
std::vector<PoseTrack::Stamped> poses_at_200_hz(double duration_s, const std::function<Pose(double)>& pose_at);

/// A made-up run of a corridor with a bend, 40 s long and with everything in it that a report shows: a drifting
/// estimate, scan matching that loses the corridor's axis for a while, a by-passed camera in the dark, three frames, a
/// map.
RunRecord synthetic_record();

}  // namespace plumbline::testing
