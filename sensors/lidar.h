#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/messages.h"
#include "sim/random_stream.h"
#include "sim/ray_scene.h"

namespace plumbline {

/// A spinning lidar as its data sheet describes it.
struct LidarModel {
  std::string name = "vlp16";
  std::vector<double> elevation_deg;        ///< per laser, in firing order
  std::vector<double> vertical_offset_m;    ///< of the laser's origin, per laser
  std::vector<double> laser_offset_s;       ///< firing time within a cycle, per laser
  double cycle_s = 55.296e-6;
  double rate_hz = 10.0;
  double min_range_m = 0.5;
  double max_range_m = 100.0;
  double range_sigma_m = 0.012;             ///< white, per return
  double range_resolution_m = 0.002;
  double ring_bias_sigma_m = 0.0;           ///< constant per laser, drawn per seed
};

/// Velodyne VLP-16: manual 63-9243, vertical angles, vertical offsets and firing times (p. 54); precision as measured.
LidarModel vlp16();

/// @throws std::invalid_argument naming the field that is out of range.
void validate_or_throw(const LidarModel& model);

class Lidar {
 public:
  /// @param seed  the scenario's; the noise is drawn from a stream named after the sensor, afresh for every scan.
  Lidar(LidarModel model, const Pose& body_from_lidar, std::uint64_t seed);

  /// Casts one revolution that starts at start_ns, each firing from the body's pose at its own time.
  /// Deterministic in (seed, scan_index), whatever came before. Azimuth turns clockwise seen from above, as the device
  /// does, from straight behind.
  /// @param world_from_body  must cover the revolution
  LidarScan scan(const RayScene& scene, const World& world, const PoseTrack& world_from_body, std::int64_t start_ns,
                 std::int64_t scan_index) const;

  const LidarModel& model() const { return model_; }
  std::int64_t period_ns() const;
  bool noise_enabled = true;

 private:
  LidarModel model_;
  Pose body_from_lidar_;
  std::uint64_t seed_ = 0;
  std::vector<int> ring_of_laser_;
  std::vector<double> ring_bias_m_;
};

}  // namespace plumbline
