#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "estimator/messages.h"

namespace plumbline {

/// The longest side of an image that is read.
inline constexpr int kMostImageSide = 8192;

/// An image file as 8-bit grey, colours weighed as for the eye. Stamp and camera are left to the caller.
/// @throws InputError for what is no image, or too large a one
CameraFrame read_grey_image(const std::filesystem::path& path);

/// A 16-bit single-channel PNG. @throws InputError as above, or for another kind of image
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint16_t> values;
};
DepthImage read_depth_image(const std::filesystem::path& path);

/// Losslessly, as PNG. @throws std::runtime_error if it cannot be written
void write_grey_image(const std::filesystem::path& path, const CameraFrame& frame);
void write_depth_image(const std::filesystem::path& path, const DepthImage& image);

}  // namespace plumbline
