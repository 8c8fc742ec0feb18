#include "sensors/lens.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline {
namespace {

// A lens of f-number N and transmission tau puts pi L tau / (4 N^2) lux on the sensor (distant object, on the axis).
constexpr double kTransmission = 0.9;

/// x/z and y/z of the rays through all pixels, row-major.
std::vector<Eigen::Vector2f> rays_of(const CameraIntrinsics& c) {
  std::vector<Eigen::Vector2f> rays;
  rays.reserve(static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height));
  for (int v = 0; v < c.height; ++v) {
    for (int u = 0; u < c.width; ++u) {
      const Eigen::Vector2d plain((u - c.cx) / c.fx, (v - c.cy) / c.fy);
      rays.push_back((c.distortion.none() ? plain : undistort(c.distortion, plain)).cast<float>());
    }
  }
  return rays;
}

}  // namespace

RenderView pinhole_view(const CameraIntrinsics& intrinsics) {
  RenderView view;
  view.width = intrinsics.width;
  view.height = intrinsics.height;
  view.fx = intrinsics.fx;
  view.fy = intrinsics.fy;
  view.cx = intrinsics.cx;
  view.cy = intrinsics.cy;
  return view;
}

Lens::Lens(const CameraModel& model, const CameraEffects& effects)
    : intrinsics_(intrinsics_of(model, effects)), view_(pinhole_view(intrinsics_)) {
  const std::vector<Eigen::Vector2f> rays = rays_of(intrinsics_);
  set_illuminance(rays, model.f_number, effects.vignetting);
  if (intrinsics_.distortion.none()) return;
  widen_view(rays);
  make_table(rays);
}

void Lens::set_illuminance(const std::vector<Eigen::Vector2f>& rays, double f_number, bool vignetting) {
  const auto on_axis = static_cast<float>(std::numbers::pi * kTransmission / (4.0 * f_number * f_number));
  lux_per_luminance_.reserve(rays.size());
  for (const Eigen::Vector2f& ray : rays) {
    const float cosine2 = 1.0F / (1.0F + ray.squaredNorm());
    lux_per_luminance_.push_back(vignetting ? on_axis * cosine2 * cosine2 : on_axis);
  }
}

void Lens::widen_view(const std::vector<Eigen::Vector2f>& rays) {
  Eigen::AlignedBox2f seen;
  for (const Eigen::Vector2f& ray : rays) seen.extend(ray);
  // A pixel of border for the interpolation.
  const double left = std::ceil(-seen.min().x() * view_.fx) + 1.0;
  const double top = std::ceil(-seen.min().y() * view_.fy) + 1.0;
  view_.width = static_cast<int>(std::ceil(left + seen.max().x() * view_.fx)) + 2;
  view_.height = static_cast<int>(std::ceil(top + seen.max().y() * view_.fy)) + 2;
  view_.cx = left;
  view_.cy = top;
}

void Lens::make_table(const std::vector<Eigen::Vector2f>& rays) {
  table_.reserve(rays.size());
  for (const Eigen::Vector2f& ray : rays) {
    const double u = ray.x() * view_.fx + view_.cx;
    const double v = ray.y() * view_.fy + view_.cy;
    const int left = static_cast<int>(u);
    const int top = static_cast<int>(v);
    table_.push_back({top * view_.width + left, static_cast<float>(u - left), static_cast<float>(v - top)});
  }
}

void Lens::add(std::span<const float> picture, int channels, std::span<const float> row_weights,
               std::span<float> sum) const {
  for (int row = 0; row < intrinsics_.height; ++row) {
    const float weight = row_weights[static_cast<std::size_t>(row)];
    if (weight != 0.0F) add_row(picture, channels, row, weight, sum);
  }
}

void Lens::add_row(std::span<const float> picture, int channels, int row, float weight, std::span<float> sum) const {
  const auto width = static_cast<std::size_t>(intrinsics_.width);
  const auto stride = static_cast<std::size_t>(channels);
  const std::size_t begin = static_cast<std::size_t>(row) * width;
  if (table_.empty()) {
    for (std::size_t i = begin * stride; i < (begin + width) * stride; ++i) sum[i] += weight * picture[i];
    return;
  }
  const std::size_t line = static_cast<std::size_t>(view_.width) * stride;
  for (std::size_t i = begin; i < begin + width; ++i) {
    const Place& place = table_[i];
    const std::size_t corner = static_cast<std::size_t>(place.upper_left) * stride;
    for (std::size_t c = 0; c < stride; ++c) {
      const float* p = &picture[corner + c];
      const float upper = p[0] + place.right * (p[stride] - p[0]);
      const float lower = p[line] + place.right * (p[line + stride] - p[line]);
      sum[i * stride + c] += weight * (upper + place.below * (lower - upper));
    }
  }
}

}  // namespace plumbline
