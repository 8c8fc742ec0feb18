#pragma once

#include <Eigen/Core>
#include <array>

#include "sensors/lidar_model.h"
#include "sensors/lidar_pattern.h"

namespace plumbline {

struct HeadRay {
  Eigen::Vector3d origin_in_head;
  Eigen::Vector3d direction_in_head;  ///< unit
};

/// A beam's section, an elliptical Gaussian that starts with the size of the exit window and widens with the
/// divergence. Places in it are (side, up) in units of the half width, at which the intensity is 1/e^2.
class LidarFootprint {
 public:
  /// Sub-rays that carry the same energy each.
  static constexpr int kRays = 12;

  explicit LidarFootprint(const LidarModel& model);

  HeadRay ray(const FiringPattern::Beam& beam, const Eigen::Vector2d& place) const;
  using Places = std::array<Eigen::Vector2d, kRays>;

  /// Where the sub-rays are: a spiral through equal shares of the energy, turned and shifted along itself by chance, so
  /// that over many firings every place counts as the Gaussian has it.
  /// @param draw  (0, 1)
  Places places(double draw) const;

 private:
  static constexpr int kShifts = 16;

  Eigen::Vector2d half_exit_m_;
  Eigen::Vector2d half_divergence_rad_;
  std::array<Places, kShifts> spirals_;
};

}  // namespace plumbline
