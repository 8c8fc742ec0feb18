#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/vision/corner_detector.h"

namespace plumbline {

struct AlignedPatch {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  float sigma_px = 0.0F;  ///< per axis, from what is left of the patches' difference
};

/// Finds where a patch of one image lies in another, to hundredths of a pixel, when it is known how the patch is
/// deformed there: Lucas and Kanade's search in its inverse compositional form (Baker and Matthews, IJCV 56, 2004) over
/// the translation and the patch's brightness and contrast. A search that takes a deformed patch for a shifted one
/// finds the place of the patch's texture instead of that of its centre, and errs by a share of the deformation.
/// What is left of the difference tells noise, and patches that lie on several surfaces and so have no one place.
/// @param now_from_anchor  the deformation, pixels by pixels
/// @param start            to a pixel or so
/// @return nothing if a patch is not inside its image, has no corner, or the search goes astray
std::optional<AlignedPatch> align_patch(const GreyView& anchor, const Eigen::Vector2f& anchor_pixel,
                                        const GreyView& now, const Eigen::Matrix2f& now_from_anchor,
                                        const Eigen::Vector2f& start);

}  // namespace plumbline
