#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/ray_scene.h"
#include "sim/trajectory.h"
#include "sim/world.h"

namespace plumbline {

inline constexpr double kLongestMotion_s = 20000.0;

/// A swing of the body about one axis, added to the path's own attitude.
struct Oscillation {
  enum class Axis { kRoll, kPitch, kYaw };
  Axis axis = Axis::kYaw;
  double amplitude_deg = 0.0;
  double frequency_hz = 1.0;
};

/// How the rig moves: along a route or through way-points at chosen speeds, by itself or carried by a vehicle; or as a
/// TUM file says.
struct MotionConfig {
  enum class Attitude {
    kHeading,  ///< level, x along the path
    kThrust    ///< as kHeading, then tilted as a rotor craft's thrust must be to give the path's acceleration
  };
  struct Waypoint {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the body, world [m]
    double speed_mps = 0.0;                              ///< from here to the next one; 0: `speed_mps` of the motion
  };

  /// Another speed along a route.
  struct Stretch {
    double from_m = 0.0;  ///< along the part of the route that is followed
    double speed_mps = 0.0;
  };
  /// A craft that flies on what an estimator says of it in place of the truth.
  struct ClosedLoop {
    bool enabled = false;
    double latency_s = 0.01;  ///< from an IMU sample's arrival to the rotors' reaction to the estimate that it brought
  };

  /// What moves: empty, a spline through the way-points; else a name of vehicle_library().
  std::string vehicle;
  /// A route of the scene to follow in place of way-points: "" for none, "tour" or its name.
  std::string route;
  double route_start_m = 0.0;         ///< along it
  double route_length_m = 0.0;        ///< how much of it; 0: to its end, or once round
  std::vector<Stretch> route_speeds;  ///< in order; before the first, `speed_mps`
  double height_m = 0.0;  ///< of the body above the route, for what is carried or flies; cars know their own

  std::filesystem::path
      tum_file;  ///< played as it is, from its first pose on; of the rest only speed_factor counts then
  std::vector<Waypoint> waypoints;  ///< z is the body's height
  double speed_mps = 1.4;
  double speed_factor = 1.0;
  double acceleration_mps2 = 1.0;          ///< along the path
  double lateral_acceleration_mps2 = 2.0;  ///< across it: routes and vehicles slow down for curves
  double rest_s = 2.0;                     ///< at the start
  double smoothing_s = 1.2;                ///< corners and changes of speed are spread over this time
  Attitude attitude = Attitude::kHeading;
  double gait_frequency_hz = 0.0;  ///< steps per second at full speed; 0: no gait
  double gait_height_m = 0.025;    ///< bob, half peak to peak
  double gait_sway_m = 0.02;
  double gait_roll_deg = 1.0;
  double gait_pitch_deg = 1.0;
  double gait_impact_mps2 = 0.0;  ///< of the heel's strike where the body is held, peak; walkers and runners only
  double gait_jump_m = 0.0;       ///< height of a runner's jump, one every few steps; 0: none
  double hand_wander_deg = 0.0;   ///< standard deviation of a hand's slow unrest, about each axis; for what is carried
  double spin_mean_dps = 0.0;     ///< the hand turns the body about ever other axes [deg/s]; 0: not at all
  double spin_peak_dps = 0.0;
  double roughness_m = 0.0;  ///< of the ground, standard deviation, finer than the scene's own; for wheels
  double wind_mps = 0.0;     ///< mean wind, with gusts, from a side that the seed chooses; for what flies
  std::vector<Oscillation> oscillations;
  ClosedLoop closed_loop;
};

/// @throws std::invalid_argument naming the field, or the file and line of a TUM file, that cannot be used.
Trajectory make_trajectory(const MotionConfig& config, const World& world, const RayScene& rays, std::uint64_t seed);

/// The same for motions that need no world: splines through way-points and TUM files.
Trajectory make_trajectory(const MotionConfig& config, std::uint64_t seed);

/// @throws std::invalid_argument("motion: " + message) unless `holds`.
void require_of_motion(bool holds, const std::string& message);

}  // namespace plumbline
