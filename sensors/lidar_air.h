#pragma once

#include "sensors/lidar_echo.h"
#include "sensors/lidar_model.h"
#include "sensors/lidar_noise.h"
#include "sensors/lidar_signal.h"
#include "sim/world.h"

namespace plumbline {

/// What rain, fog and dust do to a lidar's light: it fades on the way, and some of it comes back.
///
/// Fading: Koschmieder's extinction of fog and dust, 3.912 / visibility; of rain 1.076 R^0.67 dB/km (Carbonneau and
/// Wisely, Proc. SPIE 3532, 1998). Coming back, as the reflectivity of a plate in the echo's place:
/// - fog, a haze everywhere: pi beta c tau / 2 with beta = extinction / 18.8 sr, the ratio of water droplets, its
///   density fluctuating; after Hahner et al., ICCV 2021. Where the echo's peak is found goes with 1 / r^2.
/// - dust, in clumps that take up a tenth of the way and are ten times as dense as the mean; 50 sr (mineral dust).
/// - rain, single drops of more than 1 mm in the beam, their numbers and sizes after Marshall and Palmer (1948), each
///   with the backscatter of a water sphere.
class LidarAir {
 public:
  LidarAir(const Atmosphere& atmosphere, const LidarModel& model);

  bool is_clear() const { return extinction_per_m_ == 0.0; }
  /// T^2, there and back.
  double transmission(double range_m) const;
  /// Adds echoes from nearer than until_m.
  void add_echoes(const LidarSignal& signal, const FiringNoise& noise, double until_m, LidarEchoes& echoes) const;

 private:
  void add_fog(const LidarSignal& signal, const FiringNoise& noise, double until_m, LidarEchoes& echoes) const;
  void add_dust(const LidarSignal& signal, const FiringNoise& noise, double until_m, LidarEchoes& echoes) const;
  void add_rain(const LidarSignal& signal, const FiringNoise& noise, double until_m, LidarEchoes& echoes) const;
  void add(const LidarSignal& signal, double range_m, double reflectivity, LidarEchoes& echoes) const;

  double beam_width_m(double range_m) const { return width_m_ + divergence_ * range_m; }

  double extinction_per_m_ = 0.0;
  double fog_reflectivity_ = 0.0;
  double dust_reflectivity_ = 0.0;  ///< of a clump
  double clump_spacing_m_ = 1.0;
  double drops_per_m3_ = 0.0;   ///< of more than 1 mm
  double drop_scale_m_ = 1e-4;  ///< their diameters exceed 1 mm by this on average
  double width_m_ = 0.0;        ///< of a round beam of the same section
  double divergence_ = 0.0;
};

}  // namespace plumbline
