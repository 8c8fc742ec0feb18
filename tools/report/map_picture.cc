#include "tools/report/map_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "tools/evaluation/quantile.h"
#include "tools/formats/number_text.h"
#include "tools/formats/png.h"
#include "tools/report/markup.h"
#include "tools/report/svg_axes.h"

namespace plumbline {
namespace {

constexpr double kWidth = 1000.0;  // of the drawing; also of the raster, in pixels
constexpr double kLeastHeight = 90.0;
constexpr double kMostHeight = 900.0;
constexpr double kMarginShare = 0.04;  // of the extent, on each side
constexpr double kScaleBarRoom = 40.0;
constexpr std::size_t kMaxPathPoints = 1500;
// Stray returns far away must not shrink the rest: so large a share of the points is left outside on each side.
constexpr double kStrayShare = 0.005;
constexpr std::size_t kExtentSample = 20'000;

struct Box {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(1e300);
  Eigen::Vector2d max = Eigen::Vector2d::Constant(-1e300);
  void add(const Eigen::Vector2d& point) {
    if (!point.allFinite()) return;
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  bool empty() const { return min.x() > max.x(); }
  Eigen::Vector2d size() const { return max - min; }
};

/// Which way the picture's right and up point in the world.
struct Axes {
  Eigen::Vector3d right;
  Eigen::Vector3d up;
  const char* name;
  Eigen::Vector2d operator()(const Eigen::Vector3d& point) const { return {right.dot(point), up.dot(point)}; }
};

Axes axes_of(MapView view, bool along_y) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  if (view == MapView::kTop) return along_y ? Axes{y, -x, "y →   −x ↑"} : Axes{x, y, "x →   y ↑"};
  return along_y ? Axes{y, z, "y →   z ↑"} : Axes{x, z, "x →   z ↑"};
}

Box path_box(const std::vector<PosePair>& pairs, const Axes& axes) {
  Box box;
  for (const PosePair& pair : pairs) box.add(axes(pair.truth.translation));
  Box with_estimate = box;
  for (const PosePair& pair : pairs) with_estimate.add(axes(pair.estimate.translation));
  // An estimate that flew away leaves the picture rather than shrinking it to a dot.
  const Eigen::Vector2d room = Eigen::Vector2d::Constant(0.5 * box.size().maxCoeff() + 1.0);
  if (!box.empty()) {
    box.min = with_estimate.min.cwiseMax(box.min - room);
    box.max = with_estimate.max.cwiseMin(box.max + room);
  }
  return box;
}

/// The stretch that holds the map but for stray points.
Box map_box(const std::vector<Eigen::Vector3d>& map, const Axes& axes) {
  std::array<std::vector<double>, 2> values;
  const std::size_t stride = std::max<std::size_t>(1, map.size() / kExtentSample);
  for (std::size_t i = 0; i < map.size(); i += stride) {
    const Eigen::Vector2d at = axes(map[i]);
    if (!at.allFinite()) continue;
    values[0].push_back(at.x());
    values[1].push_back(at.y());
  }
  Box box;
  if (values[0].empty()) return box;
  box.add({*quantile(values[0], kStrayShare), *quantile(values[1], kStrayShare)});
  box.add({*quantile(values[0], 1.0 - kStrayShare), *quantile(values[1], 1.0 - kStrayShare)});
  return box;
}

/// Metres to the drawing's units, equally in both directions.
struct Frame {
  Box box;
  double units_per_m = 1.0;
  double height = kLeastHeight;

  Eigen::Vector2d operator()(const Eigen::Vector2d& at) const {
    return {(at.x() - box.min.x()) * units_per_m, (box.max.y() - at.y()) * units_per_m};
  }
};

Frame frame_of(Box box) {
  Frame frame;
  if (box.empty()) box = {Eigen::Vector2d::Constant(-1.0), Eigen::Vector2d::Constant(1.0)};
  const Eigen::Vector2d pad = Eigen::Vector2d::Constant(kMarginShare * box.size().maxCoeff() + 0.2);
  box.min -= pad;
  box.max += pad;
  const Eigen::Vector2d centre = 0.5 * (box.min + box.max);
  // The height is what the extent asks for, within limits; a box that is taller than that is fitted by its height.
  frame.units_per_m = std::min(kWidth / box.size().x(), kMostHeight / box.size().y());
  frame.height = std::clamp(box.size().y() * frame.units_per_m, kLeastHeight, kMostHeight);
  const Eigen::Vector2d half = 0.5 / frame.units_per_m * Eigen::Vector2d(kWidth, frame.height);
  frame.box = {centre - half, centre + half};
  return frame;
}

/// A sparse map is drawn with larger dots, or nobody would see it.
int dot_size(std::size_t points) { return points < 30'000 ? 3 : points < 150'000 ? 2 : 1; }

/// Density as opacity of one grey, which serves a light and a dark page alike.
std::string raster(const std::vector<Eigen::Vector3d>& map, const Axes& axes, const Frame& frame) {
  const int width = static_cast<int>(kWidth);
  const int height = static_cast<int>(std::lround(frame.height));
  cv::Mat counts(height, width, CV_32S, cv::Scalar(0));
  const int dot = dot_size(map.size());
  for (const Eigen::Vector3d& point : map) {
    const Eigen::Vector2d at = frame(axes(point));
    if (!(at.x() >= 0.0 && at.x() <= width - dot && at.y() >= 0.0 && at.y() <= height - dot)) continue;
    for (int cell = 0; cell < dot * dot; ++cell) {
      ++counts.at<int>(static_cast<int>(at.y()) + cell / dot, static_cast<int>(at.x()) + cell % dot);
    }
  }
  cv::Mat picture(height, width, CV_8UC4, cv::Scalar(128, 128, 128, 0));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int count = counts.at<int>(y, x);
      if (count > 0) picture.at<cv::Vec4b>(y, x)[3] = cv::saturate_cast<uchar>(60.0 + 45.0 * std::log2(1.0 + count));
    }
  }
  return png_data_address(encode_png(picture, 4));
}

std::string path_of(const std::vector<PosePair>& pairs, const Pose PosePair::*track, const Axes& axes,
                    const Frame& frame, const std::string& css_class) {
  const std::size_t stride = std::max<std::size_t>(1, (pairs.size() + kMaxPathPoints - 1) / kMaxPathPoints);
  std::string path = "<path class=\"line " + css_class + "\" d=\"";
  char command = 'M';
  const auto append = [&](const PosePair& pair) {
    const Eigen::Vector2d at = frame(axes((pair.*track).translation));
    if (!at.allFinite() || at.cwiseAbs().maxCoeff() > 1e5) return;
    append_fixed(path += command, at.x(), 1);
    append_fixed(path += ' ', at.y(), 1);
    command = 'L';
  };
  for (std::size_t i = 0; i < pairs.size(); i += stride) append(pairs[i]);
  if (!pairs.empty()) append(pairs.back());
  return path + "\"/>";
}

std::string marker(const Eigen::Vector2d& at, const std::string& css_class) {
  if (!at.allFinite()) return "";
  return "<circle class=\"" + css_class + "\" cx=\"" + coordinate(at.x()) + "\" cy=\"" + coordinate(at.y()) +
         "\" r=\"5\"/>";
}

std::string scale_bar(const Frame& frame, const char* axes_name) {
  const auto ticks = axis_ticks({0.0, kWidth / frame.units_per_m}, 8);
  const double length_m = ticks.size() > 1 ? ticks[1] : 1.0;
  const double y = frame.height + 14.0;
  const double length = length_m * frame.units_per_m;
  return svg_line(4.0, y, 4.0 + length, y, "scale") + svg_line(4.0, y - 5.0, 4.0, y + 5.0, "scale") +
         svg_line(4.0 + length, y - 5.0, 4.0 + length, y + 5.0, "scale") +
         svg_text(14.0 + length, y + 7.0, "start", tick_text(length_m, length_m) + " m") +
         svg_text(kWidth - 4.0, y + 7.0, "end", axes_name);
}

std::vector<Eigen::Vector3d> moved(const std::vector<MapPoint>& map, const Pose& truth_from_estimate) {
  const Eigen::Matrix3d rotation = truth_from_estimate.rotation.toRotationMatrix();
  std::vector<Eigen::Vector3d> points;
  points.reserve(map.size());
  for (const MapPoint& point : map) {
    points.emplace_back(rotation * point.position.cast<double>() + truth_from_estimate.translation);
  }
  return points;
}

}  // namespace

std::string map_picture(MapView view, const std::vector<PosePair>& aligned, const std::vector<MapPoint>& map,
                        const Pose& truth_from_estimate) {
  const std::vector<Eigen::Vector3d> points = moved(map, truth_from_estimate);
  const auto extent = [&](const Axes& axes) {
    Box box = path_box(aligned, axes);
    const Box around = map_box(points, axes);
    if (!around.empty()) {
      box.add(around.min);
      box.add(around.max);
    }
    return box;
  };
  const Eigen::Vector2d from_above = extent(axes_of(MapView::kTop, false)).size();
  const Axes axes = axes_of(view, from_above.y() > from_above.x());
  const Frame frame = frame_of(extent(axes));

  const std::string caption = view == MapView::kTop ? "From above" : "From the side";
  std::string html = "<figure class=\"map\"><figcaption>" + caption + "</figcaption>";
  html += svg_open(kWidth, frame.height + kScaleBarRoom, caption);
  html += "<image width=\"1000\" height=\"" + coordinate(std::round(frame.height)) + "\" href=\"" +
          raster(points, axes, frame) + "\"/>";
  html += path_of(aligned, &PosePair::truth, axes, frame, "truth");
  html += path_of(aligned, &PosePair::estimate, axes, frame, "estimate");
  if (!aligned.empty()) {
    html += marker(frame(axes(aligned.front().truth.translation)), "start");
    html += marker(frame(axes(aligned.back().truth.translation)), "truth end");
    html += marker(frame(axes(aligned.back().estimate.translation)), "estimate end");
  }
  return html + scale_bar(frame, axes.name) + "</svg></figure>";
}

}  // namespace plumbline
