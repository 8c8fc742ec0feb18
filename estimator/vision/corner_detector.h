#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "estimator/messages.h"

namespace plumbline {

/// An 8-bit grey image owned by someone else; rows are `stride` bytes apart.
struct GreyView {
  const std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  int stride = 0;
};

/// A frame's pixels; width * height of them must be there.
inline GreyView view_of(const CameraFrame& frame) {
  return {frame.pixels.data(), frame.width, frame.height, frame.width};
}

struct CornerOptions {
  int grid_rows = 5;
  int grid_cols = 6;
  int features_per_cell = 10;
  int border_px = 12;       ///< a tracking window must fit
  int min_distance_px = 8;  ///< between features
};

/// A sub-region's features when only a share of all is to be followed; at least one.
int features_of_share(int features_per_cell, double share);

struct Corner {
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
  double noise_sigma_px = 0.0;  ///< how far image noise alone moves a track of this corner
};

/// Standard deviation of a pixel [DN], from the image itself (median absolute response of a mask that ignores edges)
/// but at least what the data sheet promises for its brightness. Gain is unknown to the estimator, hence the image.
double image_noise_dn(const GreyView& image, const CameraNoise& data_sheet);

/// The strongest corners (Harris's structure tensor, judged by its smaller eigenvalue) of every sub-region that holds
/// fewer features than its share, away from the `occupied` pixels. A corner must stand clear of what the noise would
/// make by itself: in the dark there are none.
std::vector<Corner> find_corners(const GreyView& image, double noise_dn, const std::vector<Eigen::Vector2f>& occupied,
                                 const CornerOptions& options);

}  // namespace plumbline
