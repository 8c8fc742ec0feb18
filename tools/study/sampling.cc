#include "tools/study/sampling.h"

#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr int kBits = 32;

/// One row of the table: the primitive polynomial's degree and inner coefficients, and the first direction numbers.
struct SobolDimension {
  unsigned degree = 0;
  unsigned coefficients = 0;
  std::array<std::uint32_t, 6> first{};
};

// The first dimension is the van der Corput sequence, which needs no polynomial.
constexpr std::array<SobolDimension, kSobolDimensions - 1> kDimensions = {{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
}};

using Directions = std::array<std::uint32_t, kBits>;

/// v_i = m_i / 2^i, as 32-bit fractions.
Directions directions_of(std::size_t dimension) {
  Directions v{};
  if (dimension == 0) {
    for (unsigned i = 0; i < kBits; ++i) v[i] = std::uint32_t{1} << (kBits - 1 - i);
    return v;
  }
  const SobolDimension& row = kDimensions.at(dimension - 1);
  for (unsigned i = 0; i < row.degree; ++i) v[i] = row.first[i] << (kBits - 1 - i);
  // Joe and Kuo's equation (2): the recurrence of the primitive polynomial.
  for (unsigned i = row.degree; i < kBits; ++i) {
    v[i] = v[i - row.degree] ^ (v[i - row.degree] >> row.degree);
    for (unsigned k = 1; k < row.degree; ++k) {
      if ((row.coefficients >> (row.degree - 1 - k) & 1U) != 0) v[i] ^= v[i - k];
    }
  }
  return v;
}

std::vector<std::size_t> shuffled(std::size_t count, RandomStream& stream) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(stream.integer(0, static_cast<int>(i) - 1))]);
  }
  return order;
}

}  // namespace

UnitPoints latin_hypercube(std::size_t count, const std::vector<std::string>& names) {
  UnitPoints points(count, std::vector<double>(names.size()));
  for (std::size_t d = 0; d < names.size(); ++d) {
    RandomStream stream(1, "sweep.latin_hypercube." + names[d]);
    const std::vector<std::size_t> strata = shuffled(count, stream);
    for (std::size_t i = 0; i < count; ++i) {
      points[i][d] = (static_cast<double>(strata[i]) + stream.uniform()) / static_cast<double>(count);
    }
  }
  return points;
}

UnitPoints sobol_points(std::size_t count, std::size_t dimensions) {
  if (dimensions > kSobolDimensions) {
    throw std::invalid_argument("sobol_points: found " + std::to_string(dimensions) + " dimensions, at most " +
                                std::to_string(kSobolDimensions) + " are known");
  }
  UnitPoints points(count, std::vector<double>(dimensions));
  for (std::size_t d = 0; d < dimensions; ++d) {
    const Directions v = directions_of(d);
    std::uint32_t x = 0;
    for (std::size_t i = 0; i < count; ++i) {
      // Gray-code order: each point differs from the one before by the direction of the lowest zero bit of its index.
      x ^= v[static_cast<std::size_t>(std::countr_one(static_cast<std::uint32_t>(i)))];
      points[i][d] = static_cast<double>(x) * 0x1p-32;
    }
  }
  return points;
}

}  // namespace plumbline
