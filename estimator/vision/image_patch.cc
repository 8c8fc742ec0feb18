#include "estimator/vision/image_patch.h"

#include <cmath>

namespace plumbline {

bool inside(const GreyView& image, const Eigen::Vector2f& pixel, float border) {
  return pixel.x() >= border && pixel.y() >= border && pixel.x() < static_cast<float>(image.width) - border - 1.0F &&
         pixel.y() < static_cast<float>(image.height) - border - 1.0F;
}

Patch read_patch(const GreyView& image, const Eigen::Vector2f& centre) {
  Patch patch;
  const int x0 = static_cast<int>(centre.x());
  const int y0 = static_cast<int>(centre.y());
  const float a = centre.x() - static_cast<float>(x0);
  const float b = centre.y() - static_cast<float>(y0);
  std::size_t i = 0;
  for (int v = y0 - kPatchRadius; v <= y0 + kPatchRadius; ++v) {
    const std::uint8_t* upper = image.data + static_cast<std::ptrdiff_t>(v) * image.stride;
    const std::uint8_t* lower = upper + image.stride;
    for (int u = x0 - kPatchRadius; u <= x0 + kPatchRadius; ++u) {
      patch[i++] = (1.0F - b) * ((1.0F - a) * static_cast<float>(upper[u]) + a * static_cast<float>(upper[u + 1])) +
                   b * ((1.0F - a) * static_cast<float>(lower[u]) + a * static_cast<float>(lower[u + 1]));
    }
  }
  return patch;
}

double correlation(const Patch& p, const Patch& q) {
  double sum_p = 0.0;
  double sum_q = 0.0;
  double sum_pp = 0.0;
  double sum_qq = 0.0;
  double sum_pq = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto x = static_cast<double>(p[i]);
    const auto y = static_cast<double>(q[i]);
    sum_p += x;
    sum_q += y;
    sum_pp += x * x;
    sum_qq += y * y;
    sum_pq += x * y;
  }
  const auto n = static_cast<double>(p.size());
  const double variances = (sum_pp - sum_p * sum_p / n) * (sum_qq - sum_q * sum_q / n);
  return variances > 0.0 ? (sum_pq - sum_p * sum_q / n) / std::sqrt(variances) : 0.0;
}

}  // namespace plumbline
