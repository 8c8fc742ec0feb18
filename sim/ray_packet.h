#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace plumbline {

/// Rays that are cast together. What they meet does not depend on the company; they cost least if they start close to
/// each other and go about the same way.
struct RayPacket {
  static constexpr std::size_t kMost = 8;

  std::size_t size = 0;
  std::array<Eigen::Vector3d, kMost> origins;
  std::array<Eigen::Vector3d, kMost> directions;  ///< unit length
  std::array<double, kMost> times_s;
};

}  // namespace plumbline
