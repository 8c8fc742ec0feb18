#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimator/vision/motion_constraints.h"

namespace plumbline {

/// How much better "rides on the rig" explains what a feature did since the reference image than "stands in the world":
/// the difference of two squared pixel errors, in units of twice their variance, each bounded. A rider keeps its pixel.
/// What stands in the world is where the motion puts it: on its epipolar line, or, its depth being known, at a point.
/// Positive for a rider in a turn, negative for the world, about zero where the motion cannot tell them apart.
/// @param motion  from the reference to now; its rotation had better not come from these features
double evidence_of_riding(const CameraMotion& motion, const CameraIntrinsics& camera, const FeatureSighting& feature);

/// A bonnet, a mast, rotor guards: driving straight ahead they look like points at infinity, and there are enough of
/// them to outvote a bend. Nothing of the rig's shape need be known. Sums evidence over reference images, within
/// bounds, so that a track can change its mind.
class RidingEvidence {
 public:
  void add(double evidence);
  bool rides() const;

 private:
  double sum_ = 0.0;
};

/// Where features rode on the rig, in pixels of the image as it came. Old places are forgotten: a mistake must not
/// blind for good.
class RiddenPlaces {
 public:
  void add(std::int64_t stamp_ns, const Eigen::Vector2f& image_pixel);
  void forget_before(std::int64_t stamp_ns);
  const std::vector<Eigen::Vector2f>& pixels() const { return pixels_; }

 private:
  std::vector<std::int64_t> stamps_ns_;  // of pixels_, ascending
  std::vector<Eigen::Vector2f> pixels_;
};

}  // namespace plumbline
