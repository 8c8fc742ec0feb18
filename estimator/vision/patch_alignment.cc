#include "estimator/vision/patch_alignment.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "estimator/vision/image_patch.h"

namespace plumbline {
namespace {

constexpr int kRadius = 7;  // [px]
constexpr int kSide = 2 * kRadius + 1;
constexpr int kRimmedSide = kSide + 2;
constexpr float kCount = kSide * kSide;
constexpr int kMostIterations = 8;
constexpr float kConverged_px = 0.01F;
constexpr float kFurthest_px = 2.0F;        // from the start
constexpr float kLeastDeterminant = 1e-3F;  // of the structure tensor, over its squared trace
constexpr float kLeastContrast = 0.2F;      // over the anchor's
// Differences of neighbouring pixels are alike where they are not noise. Against the truth, patches on one surface err
// by 1 to 1.5 times what independent differences would move them by, those on several by 2 to 4 times.
constexpr float kAlikeness = 1.5F;

template <int Side>
using Samples = Eigen::Matrix<float, Side * Side, 1>;  ///< row by row

/// Bilinear samples, one a pixel, around a place.
template <int Side>
void sample(const GreyView& image, const Eigen::Vector2f& centre, Samples<Side>& samples) {
  const int left = static_cast<int>(centre.x()) - Side / 2;
  const int top = static_cast<int>(centre.y()) - Side / 2;
  const float a = centre.x() - std::floor(centre.x());
  const float b = centre.y() - std::floor(centre.y());
  const float w00 = (1.0F - a) * (1.0F - b);
  const float w01 = a * (1.0F - b);
  const float w10 = (1.0F - a) * b;
  const float w11 = a * b;
  float* out = samples.data();
  for (int row = 0; row < Side; ++row) {
    const std::uint8_t* upper = image.data + static_cast<std::ptrdiff_t>(top + row) * image.stride + left;
    const std::uint8_t* lower = upper + image.stride;
    for (int column = 0; column < Side; ++column) {
      *out++ = w00 * static_cast<float>(upper[column]) + w01 * static_cast<float>(upper[column + 1]) +
               w10 * static_cast<float>(lower[column]) + w11 * static_cast<float>(lower[column + 1]);
    }
  }
}

/// The same where `step` holds the steps from column to column and from row to row.
template <int Side>
void sample(const GreyView& image, const Eigen::Vector2f& centre, const Eigen::Matrix2f& step, Samples<Side>& samples) {
  const Eigen::Vector2f corner = centre - static_cast<float>(Side / 2) * (step.col(0) + step.col(1));
  float* out = samples.data();
  for (int row = 0; row < Side; ++row) {
    float x = corner.x() + static_cast<float>(row) * step(0, 1);
    float y = corner.y() + static_cast<float>(row) * step(1, 1);
    for (int column = 0; column < Side; ++column) {
      const int left = static_cast<int>(x);
      const int top = static_cast<int>(y);
      const float a = x - static_cast<float>(left);
      const float b = y - static_cast<float>(top);
      const std::uint8_t* upper = image.data + static_cast<std::ptrdiff_t>(top) * image.stride + left;
      const std::uint8_t* lower = upper + image.stride;
      const float above = static_cast<float>(upper[0]) + a * static_cast<float>(upper[1] - upper[0]);
      const float below = static_cast<float>(lower[0]) + a * static_cast<float>(lower[1] - lower[0]);
      *out++ = above + b * (below - above);
      x += step(0, 0);
      y += step(1, 0);
    }
  }
}

/// The anchor's patch and its gradient, all free of their means, so that brightness drops out.
struct Template {
  Eigen::Matrix<float, kSide * kSide, 3> columns;  ///< gradient along x and y, grey
  Eigen::Matrix3f normal;
};

Template make_template(const GreyView& image, const Eigen::Vector2f& pixel) {
  Samples<kRimmedSide> rimmed;
  sample<kRimmedSide>(image, pixel, rimmed);
  Template made;
  for (int row = 0, i = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column, ++i) {
      const int at = (row + 1) * kRimmedSide + column + 1;
      made.columns(i, 0) = 0.5F * (rimmed[at + 1] - rimmed[at - 1]);
      made.columns(i, 1) = 0.5F * (rimmed[at + kRimmedSide] - rimmed[at - kRimmedSide]);
      made.columns(i, 2) = rimmed[at];
    }
  }
  for (int k = 0; k < 3; ++k) made.columns.col(k).array() -= made.columns.col(k).sum() / kCount;
  for (int k = 0; k < 3; ++k) {
    for (int l = k; l < 3; ++l) {
      made.normal(k, l) = made.normal(l, k) = made.columns.col(k).dot(made.columns.col(l));
    }
  }
  return made;
}

bool has_corner(const Template& patch) {
  const Eigen::Matrix2f tensor = patch.normal.topLeftCorner<2, 2>();
  return tensor.determinant() > kLeastDeterminant * tensor.trace() * tensor.trace();
}

}  // namespace

std::optional<AlignedPatch> align_patch(const GreyView& anchor, const Eigen::Vector2f& anchor_pixel,
                                        const GreyView& now, const Eigen::Matrix2f& now_from_anchor,
                                        const Eigen::Vector2f& start) {
  if (!inside(anchor, anchor_pixel, kRadius + 1.0F)) return std::nullopt;
  const Template wanted = make_template(anchor, anchor_pixel);
  if (!has_corner(wanted)) return std::nullopt;
  const Eigen::Matrix3f inverse = wanted.normal.inverse();

  const float border = kRadius * now_from_anchor.cwiseAbs().rowwise().sum().maxCoeff() + 1.0F;
  AlignedPatch aligned{start};
  Samples<kSide> found;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    if (!inside(now, aligned.pixel, border)) return std::nullopt;
    sample<kSide>(now, aligned.pixel, now_from_anchor, found);
    // found = brightness + contrast * (template shifted by s), s small: the columns' factors are contrast * s and
    // contrast. Their means are zero, so that the brightness falls out of the products.
    const Eigen::Vector3f products(wanted.columns.col(0).dot(found), wanted.columns.col(1).dot(found),
                                   wanted.columns.col(2).dot(found));
    const Eigen::Vector3f factors = inverse * products;
    const float contrast = factors.z();
    if (!(contrast > kLeastContrast)) return std::nullopt;
    const Eigen::Vector2f step = now_from_anchor * factors.head<2>() / contrast;
    aligned.pixel -= step;
    if (!((aligned.pixel - start).norm() < kFurthest_px)) return std::nullopt;
    if (step.norm() > kConverged_px && iteration + 1 < kMostIterations) continue;
    found.array() -= found.sum() / kCount;
    const float variance = std::max(0.0F, found.squaredNorm() - factors.dot(products)) / (kCount - 4.0F);
    aligned.sigma_px = kAlikeness * std::sqrt(0.5F * variance * inverse.topLeftCorner<2, 2>().trace()) / contrast;
    break;
  }
  return aligned;
}

}  // namespace plumbline
