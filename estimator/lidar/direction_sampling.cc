#include "estimator/lidar/direction_sampling.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "estimator/lidar/facing_side.h"

namespace plumbline {
namespace {

constexpr int kStepsPerAxis = 3;  // each face of the cube of directions is cut 3 x 3
constexpr int kBins = 6 * kStepsPerAxis * kStepsPerAxis;

int direction_bin(const Eigen::Vector3f& normal) {
  const int side = facing_side(normal);
  if (side > 5) return 0;
  const int axis = side / 2;
  const float scale = 1.0F / std::abs(normal[axis]);
  const auto step = [&](int other) {
    const float along = normal[(axis + other) % 3] * scale;  // -1..1 across the face
    return std::clamp(static_cast<int>((along + 1.0F) * 0.5F * kStepsPerAxis), 0, kStepsPerAxis - 1);
  };
  return (side * kStepsPerAxis + step(1)) * kStepsPerAxis + step(2);
}

/// Shares a budget out: bins that need less than an equal share get all they need, and the rest share what is left.
std::array<int, kBins> fill_evenly(const std::array<int, kBins>& wanted, int budget) {
  std::array<int, kBins> order{};
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return wanted[static_cast<std::size_t>(a)] < wanted[static_cast<std::size_t>(b)];
  });
  std::array<int, kBins> granted{};
  for (int k = 0; k < kBins; ++k) {
    const auto bin = static_cast<std::size_t>(order[static_cast<std::size_t>(k)]);
    granted[bin] = std::min(wanted[bin], budget / (kBins - k));
    budget -= granted[bin];
  }
  return granted;
}

}  // namespace

std::vector<std::uint32_t> sample_by_direction(const std::vector<FeaturePoint>& planes, int budget) {
  // The k-th of n is taken where k * taken / n steps: evenly along the scan, that is over space.
  const auto takes = [](int k, int taken, int n) { return (k + 1) * taken / n > k * taken / n; };
  const auto all = static_cast<int>(planes.size());
  const int anywhere = std::min(all, budget / 2);
  std::vector<std::uint8_t> bins(planes.size());
  std::vector<std::uint8_t> taken(planes.size());
  std::array<int, kBins> wanted{};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    taken[i] = takes(static_cast<int>(i), anywhere, all) ? 1 : 0;
    bins[i] = static_cast<std::uint8_t>(direction_bin(planes[i].normal));
    if (taken[i] == 0) ++wanted[bins[i]];
  }
  const std::array<int, kBins> granted = fill_evenly(wanted, budget - anywhere);
  std::vector<std::uint32_t> picked;
  picked.reserve(static_cast<std::size_t>(budget));
  std::array<int, kBins> seen{};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const std::size_t bin = bins[i];
    if (taken[i] != 0 || takes(seen[bin]++, granted[bin], wanted[bin])) picked.push_back(static_cast<std::uint32_t>(i));
  }
  return picked;
}

std::vector<FeaturePoint> every_nth(const std::vector<FeaturePoint>& features, int budget) {
  std::vector<FeaturePoint> picked;
  const std::size_t count = std::min(features.size(), static_cast<std::size_t>(budget));
  picked.reserve(count);
  for (std::size_t k = 0; k < count; ++k) picked.push_back(features[k * features.size() / count]);
  return picked;
}

std::vector<FeaturePoint> pick(const std::vector<FeaturePoint>& features, const std::vector<std::uint32_t>& which) {
  std::vector<FeaturePoint> picked;
  picked.reserve(which.size());
  for (const std::uint32_t i : which) picked.push_back(features[i]);
  return picked;
}

}  // namespace plumbline
