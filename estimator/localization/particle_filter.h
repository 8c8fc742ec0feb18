#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "estimator/lidar/correspondence.h"
#include "estimator/lidar/voxel_map.h"
#include "estimator/localization/map_localizer.h"

namespace plumbline {

/// The baseline of thesis 8.2, Fig. 8.5: particles moved by odometry, weighed by the scan's likelihood on the map,
/// resampled at every update.
class ParticleFilter {
 public:
  static constexpr int kParticles = 50;

  ParticleFilter(const Calibration& calibration, const PriorMap& map, const Pose& map_from_start);

  MapFix locate(std::int64_t stamp_ns, const FeatureCloud& stack, const OdometryReading& odometry);

  const AgreementGate& gate() const { return gate_; }

 private:
  /// A scan's likelihood at one pose.
  struct Likelihood {
    double log = 0.0;
    std::vector<FeaturePoint> on_map;
  };

  void move_by(const Pose& motion, double blind_m, double seconds);
  Likelihood likelihood(const std::vector<FeaturePoint>& points, const Pose& map_from_body) const;
  std::vector<double> weigh(const std::vector<FeaturePoint>& points) const;
  void resample(const std::vector<double>& weights);
  double gaussian();
  double uniform();

  VoxelMap planes_;
  Occupancy occupancy_;
  FitLimits limits_;
  AgreementGate gate_;
  std::mt19937_64 random_;           ///< its sequence is fixed by the standard; distributions are not
  std::vector<Pose> map_from_body_;  ///< the particles
  std::optional<OdometryReading> last_odometry_;
  std::int64_t last_ns_ = 0;
};

}  // namespace plumbline
