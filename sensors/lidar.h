#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/messages.h"
#include "sim/random_stream.h"
#include "sim/surroundings.h"

namespace plumbline {

/// A spinning lidar as its data sheet describes it.
struct LidarModel {
  std::string name = "vlp16";
  std::vector<double> elevation_deg;      ///< per laser, in firing order
  std::vector<double> vertical_offset_m;  ///< of the laser's origin, per laser
  std::vector<double> laser_offset_s;     ///< firing time within a cycle, per laser
  double cycle_s = 55.296e-6;
  double rate_hz = 10.0;
  double min_range_m = 0.5;
  double max_range_m = 100.0;
  double range_at_10_percent_m = 50.0;  ///< how far a plate of 10 % reflectivity, seen head-on, still gives a return
  double range_sigma_m = 0.012;         ///< white, per return
  double range_resolution_m = 0.002;
  double ring_bias_sigma_m = 0.0;  ///< constant per laser, drawn per seed
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
  /// does, from straight behind. A surface nearer than the least range hides what is behind it and gives no return; nor
  /// does one too dark, too oblique or too far for its light to arrive. Intensity is reflectivity times the cosine of
  /// the angle of incidence, as of a device that compensates for range.
  /// @param world_from_body  must cover the revolution
  /// @throws std::invalid_argument if it does not
  LidarScan scan(const Surroundings& surroundings, const PoseTrack& world_from_body, std::int64_t start_ns,
                 std::int64_t scan_index) const;

  const LidarModel& model() const { return model_; }
  std::int64_t period_ns() const;
  /// False makes an ideal device: exact ranges, and a return from every surface within range.
  bool noise_enabled = true;

 private:
  struct Laser {
    double cos_elevation = 1.0;
    double sin_elevation = 0.0;
    double vertical_offset_m = 0.0;
    double range_bias_m = 0.0;
    double share_of_cycle = 0.0;  ///< of the cycle's time at which it fires
    std::int32_t offset_ns = 0;   ///< within the cycle
    std::uint16_t ring = 0;
  };

  std::optional<LidarPoint> fire(const Surroundings& surroundings, const Pose& world_from_lidar, const Laser& laser,
                                 std::int32_t offset_ns, double range_noise_m) const;
  double measured_range(double true_range_m, const Laser& laser, double range_noise_m) const;
  bool is_detected(double range_m, double reflectivity_towards_lidar) const;

  LidarModel model_;
  Pose body_from_lidar_;
  std::uint64_t seed_ = 0;
  std::vector<Laser> lasers_;  ///< in firing order
};

}  // namespace plumbline
