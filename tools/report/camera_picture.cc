#include "tools/report/camera_picture.h"

#include <algorithm>
#include <opencv2/core.hpp>

#include "tools/formats/number_text.h"
#include "tools/formats/png.h"
#include "tools/report/markup.h"
#include "tools/report/svg_axes.h"

namespace plumbline {
namespace {

constexpr std::size_t kMaxFeatures = 1000;

std::string png_of(const CameraFrame& frame) {
  const std::size_t size = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  if (frame.width <= 0 || frame.height <= 0 || frame.pixels.size() != size) return {};
  cv::Mat picture(frame.height, frame.width, CV_8U);
  std::copy(frame.pixels.begin(), frame.pixels.end(), picture.begin<std::uint8_t>());
  return png_data_address(encode_png(picture, 2));
}

std::string depth_class(const TrackedFeature& feature) {
  switch (feature.depth) {
    case TrackedFeature::Depth::kLidar:
      return "depth-lidar";
    case TrackedFeature::Depth::kTriangulated:
      return "depth-triangulated";
    case TrackedFeature::Depth::kNone:
      break;
  }
  return "depth-none";
}

std::string drawn(const TrackedFeature& feature) {
  const Eigen::Vector2f& at = feature.pixel;
  const Eigen::Vector2f& from = feature.keyframe_pixel;
  if (!at.allFinite() || !from.allFinite()) return {};
  const std::string css_class = feature.inlier ? depth_class(feature) : "outlier";
  std::string svg = svg_line(from.x(), from.y(), at.x(), at.y(), "track " + css_class);
  if (feature.inlier) {
    return svg + "<circle class=\"feature " + css_class + "\" cx=\"" + coordinate(at.x()) + "\" cy=\"" +
           coordinate(at.y()) + "\" r=\"3\"/>";
  }
  return svg + svg_line(at.x() - 3.5, at.y() - 3.5, at.x() + 3.5, at.y() + 3.5, "feature " + css_class) +
         svg_line(at.x() - 3.5, at.y() + 3.5, at.x() + 3.5, at.y() - 3.5, "feature " + css_class);
}

}  // namespace

std::string camera_picture(const FrameSnapshot& snapshot, std::int64_t start_ns) {
  const std::string picture = png_of(snapshot.frame);
  if (picture.empty()) return {};
  const std::string caption = fixed_text(seconds_between(start_ns, snapshot.frame.stamp_ns), 2) + " s, " +
                              std::to_string(snapshot.features.size()) + " features";
  std::string html = "<figure class=\"camera\">" + svg_open(snapshot.frame.width, snapshot.frame.height, caption);
  html += "<image width=\"" + std::to_string(snapshot.frame.width) + "\" height=\"" +
          std::to_string(snapshot.frame.height) + "\" href=\"" + picture + "\"/>";
  for (std::size_t i = 0; i < std::min(snapshot.features.size(), kMaxFeatures); ++i)
    html += drawn(snapshot.features[i]);
  return html + "</svg><figcaption>" + escape_markup(caption) + "</figcaption></figure>";
}

std::string camera_legend() {
  return legend({{"depth-lidar", "depth from lidar"},
                 {"depth-triangulated", "triangulated"},
                 {"depth-none", "no depth"},
                 {"outlier", "outlier"}});
}

}  // namespace plumbline
