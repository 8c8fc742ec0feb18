#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/evaluation/pairing.h"

/// The one transform that brings an estimate into the truth's world before errors are taken.
namespace plumbline {

/// p_truth = scale * rotation * p_estimate + translation.
struct Alignment {
  Pose truth_from_estimate;
  double scale = 1.0;

  Pose apply(const Pose& estimate) const;
};

enum class AlignmentKind { kNone, kOrigin, kYaw, kSe3, kSim3 };

/// @returns nothing for a word other than none, origin, yaw, se3, sim3
std::optional<AlignmentKind> alignment_kind(const std::string& name);

/// Drift's alignment: best fits the first second of poses. The body may rest there, so positions alone would leave the
/// rotation open: the rotation is the (chordal) mean of truth * estimate^-1, the translation the mean that then
/// remains. Identity when there are no pairs.
Pose align_first_second(const std::vector<PosePair>& pairs);

/// Over all pairs. `origin` maps the first estimate onto the first truth; `yaw` turns about the vertical only; `se3`
/// and `sim3` follow Umeyama, PAMI 13(4), 1991, eqs. 38-42, on the positions. Attitudes enter with a weight, a share of
/// the path's extent: 1 % settles the roll about a straight path and moves nothing else.
Alignment align(const std::vector<PosePair>& pairs, AlignmentKind kind, double attitude_weight = 0.01);

/// Where a run's map lies in the true world, as surveyors would lay it on its site: by points along the way whose
/// places are known, and by the vertical, since points along two lanes some metres apart would tell the roll about them
/// from how far either has drifted.
Pose place_on_site(const std::vector<PosePair>& pairs);

}  // namespace plumbline
