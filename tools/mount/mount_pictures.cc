#include "tools/mount/mount_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "tools/formats/png.h"
#include "tools/report/markup.h"
#include "tools/report/svg_axes.h"

namespace plumbline {
namespace {

constexpr double kFigureWidth = 560.0;

/// @param grey  of a pixel, [0, 1]
/// @param stretch  height of the picture's rows over their width
template <typename Grey>
std::string figure(const MountView::Picture& picture, const std::string& caption, double stretch, Grey grey) {
  cv::Mat3b image(picture.height, picture.width);
  for (int i = 0; i < picture.height * picture.width; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const auto value = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp<double>(grey(at), 0.0, 1.0)));
    const bool is_own = picture.brightness[at] < 0.0F;
    image(i / picture.width, i % picture.width) = is_own ? cv::Vec3b(40, 40, 190) : cv::Vec3b(value, value, value);
  }
  const double height = kFigureWidth * stretch * picture.height / picture.width;
  return "<figure>" + svg_open(kFigureWidth, height, caption) + "<image width=\"" + coordinate(kFigureWidth) +
         "\" height=\"" + coordinate(height) + "\" preserveAspectRatio=\"none\" href=\"" +
         png_data_address(encode_png(image, 4)) + "\"/></svg><figcaption>" + escape_markup(caption) +
         "</figcaption></figure>";
}

}  // namespace

std::string lidar_view_figure(const MountView::Picture& picture, const std::string& caption) {
  // Beams are drawn as high as their usual spacing, 2 degrees of 360, is wide, and never lower than a third of that.
  const double stretch = std::clamp(60.0 / picture.height, 1.0 / 3.0, 4.0);
  return figure(picture, caption, stretch, [&](std::size_t i) {
    const float range_m = picture.range_m[i];
    return range_m > 0.0F ? 1.0 / (1.0 + 0.1 * range_m) : 0.0;
  });
}

std::string camera_view_figure(const MountView::Picture& picture, const std::string& caption) {
  return figure(picture, caption, 1.0, [&](std::size_t i) { return std::sqrt(picture.brightness[i]); });
}

}  // namespace plumbline
