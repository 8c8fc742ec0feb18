#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "estimator/messages.h"
#include "sensors/lidar_air.h"
#include "sensors/lidar_caster.h"
#include "sensors/lidar_echo.h"
#include "sensors/lidar_footprint.h"
#include "sensors/lidar_model.h"
#include "sensors/lidar_noise.h"
#include "sensors/lidar_pattern.h"
#include "sensors/lidar_signal.h"
#include "sim/surroundings.h"

namespace plumbline {

/// What makes a lidar a real one; each can be left out on its own.
struct LidarEffects {
  bool range_noise = true;   ///< white, growing as the light fades: see LidarSignal
  bool ring_bias = true;     ///< constant per laser
  bool drop_out = true;      ///< surfaces too dark, oblique or far do not return; without, all within range do
  bool mixed_pixels = true;  ///< the beam has a width: at an edge it meets several surfaces
  bool weather = true;       ///< World::atmosphere
  bool own_body = true;      ///< the vehicle is in view
  bool quantisation = true;  ///< of ranges and of the encoder's angle

  /// An ideal device.
  static LidarEffects none() { return {false, false, false, false, false, false, false}; }
};

/// Which of a firing's echoes are reported.
enum class LidarReturns {
  kStrongest,
  kLast,
  kDual  ///< the strongest, then the last; where they are one, the second strongest
};

class Lidar {
 public:
  /// @param seed  the scenario's; the noise is drawn from a stream named after the sensor, afresh for every firing.
  /// @throws std::invalid_argument as validate_or_throw
  Lidar(LidarModel model, const Pose& body_from_lidar, std::uint64_t seed, const LidarEffects& effects = {},
        LidarReturns returns = LidarReturns::kStrongest);

  /// Casts one message that starts at start_ns, each firing from the body's pose at its own time: a revolution
  /// (clockwise seen from above, from straight behind), or a part of a 2-axis head's sweep. The device's own clock and
  /// its joint count from message 0. Deterministic in (seed, scan_index), whatever came before; what a firing draws
  /// does not depend on the other firings' returns.
  ///
  /// A surface nearer than the least range hides what is behind it and gives no return. Intensity is reflectivity times
  /// the cosine of the angle of incidence, as of a device that compensates for range.
  /// @param world_from_body  must cover the message
  /// @throws std::invalid_argument if it does not
  LidarScan scan(const Surroundings& surroundings, const PoseTrack& world_from_body, std::int64_t start_ns,
                 std::int64_t scan_index) const;

  const LidarModel& model() const { return model_; }
  const FiringPattern& pattern() const { return pattern_; }
  std::int64_t period_ns() const { return message_period_ns(model_); }

 private:
  /// A cycle of the head, and what its beams' centre rays meet.
  struct CastCycle {
    const FiringPattern::Cycle* cycle = nullptr;
    HeadMotion motion;
    std::vector<LidarHit> hits;  ///< per beam
  };
  /// One laser's, among those around it in time.
  struct Firing {
    const CastCycle* before = nullptr;  ///< nullptr: none in this message
    const CastCycle& at;
    const CastCycle* after = nullptr;
    std::size_t beam = 0;
    std::int64_t time_ps = 0;  ///< since the message's start
    FiringNoise noise;
  };

  bool fires(const FiringPattern::Cycle& cycle, const FiringPattern::Beam& beam) const;
  void cast_centres(std::span<const FiringPattern::Cycle> cycles, LidarCaster& caster, std::span<CastCycle> cast) const;
  void find_echoes(const Firing& firing, const LidarAir& air, const LidarCaster& caster, LidarEchoes& echoes) const;
  bool meets_an_edge(const Firing& firing, const LidarCaster& caster) const;
  void add_sub_rays(const Firing& firing, const LidarAir& air, const LidarCaster& caster, LidarEchoes& echoes) const;
  LidarEcho echo_of(const LidarHit& hit, const LidarAir& air) const;
  bool is_detected(const LidarEcho& echo, unsigned index, const FiringNoise& noise) const;
  void report(const LidarEchoes& echoes, const Firing& firing, std::vector<LidarPoint>& points) const;
  void add_point(const LidarEcho& echo, FiringNoise::Source source, const Firing& firing,
                 std::vector<LidarPoint>& points) const;

  LidarModel model_;
  FiringPattern pattern_;
  LidarSignal signal_;
  LidarFootprint footprint_;
  Pose body_from_lidar_;
  std::uint64_t seed_ = 0;
  LidarEffects effects_;
  LidarReturns returns_;
  double echo_resolution_m_ = 0.0;    ///< nearer echoes are one pulse to the receiver
  std::vector<double> range_bias_m_;  ///< per beam
};

}  // namespace plumbline
