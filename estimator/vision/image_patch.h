#pragma once

#include <array>
#include <cstddef>

#include "estimator/vision/corner_detector.h"

/// Small square patches of an image, to tell whether two places look alike.
namespace plumbline {

inline constexpr int kPatchRadius = 5;  ///< [px]
inline constexpr int kPatchSide = 2 * kPatchRadius + 1;
using Patch = std::array<float, static_cast<std::size_t>(kPatchSide) * kPatchSide>;

/// Whether a place lies at least `border` pixels inside the image.
bool inside(const GreyView& image, const Eigen::Vector2f& pixel, float border);

/// Bilinear samples around a place that is inside by kPatchRadius + 1.
Patch read_patch(const GreyView& image, const Eigen::Vector2f& centre);

/// Zero-mean normalised cross-correlation, in [-1, 1]; blind to brightness and contrast. 0 for a patch without texture.
double correlation(const Patch& p, const Patch& q);

}  // namespace plumbline
