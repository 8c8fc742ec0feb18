#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace plumbline {

/// Repeated centred box filters, each over 2 * half + 1 values; four passes make a kernel with three continuous
/// derivatives. The result stays within the input's convex hull; the ends are held.
template <typename T>
std::vector<T> box_smoothed(std::vector<T> values, std::ptrdiff_t half, int passes = 4) {
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const auto at = [&](std::ptrdiff_t i) {
    return values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, n - 1))];
  };
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<T> next(values);
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      T sum = at(i);
      for (std::ptrdiff_t k = 1; k <= half; ++k) sum += at(i - k) + at(i + k);
      next[static_cast<std::size_t>(i)] = sum / static_cast<double>(2 * half + 1);
    }
    values = std::move(next);
  }
  return values;
}

}  // namespace plumbline
