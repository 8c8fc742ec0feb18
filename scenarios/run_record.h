#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "estimator/estimator.h"
#include "estimator/geometry/interpolation.h"

namespace plumbline {

struct MessageTally {
  std::int64_t produced = 0;
  std::int64_t used = 0;
  std::map<std::string, std::int64_t> dropped;  ///< reason -> count
};

/// A camera frame as the estimator saw it, with what it tracked there.
struct FrameSnapshot {
  CameraFrame frame;
  std::vector<TrackedFeature> features;
};

/// One message's way through the estimator, a row of timing.csv.
struct TimingRow {
  std::int64_t stamp_ns = 0;
  Module module = Module::kImu;
  double wall_s = 0.0;
};

/// A moment of a flight in closed loop; positions of the craft's middle, in the world [m].
struct FlightSample {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d wanted = Eigen::Vector3d::Zero();  ///< by the mission
  Eigen::Vector3d flown = Eigen::Vector3d::Zero();
  /// Of the newest estimate that the controller had, at that estimate's own stamp, in the mission's frame.
  Eigen::Vector3d estimate_error = Eigen::Vector3d::Zero();
  /// From the craft's hull to the nearest surface that stands still, at most kMostClearance_m.
  double clearance_m = 0.0;
};
inline constexpr double kMostClearance_m = 5.0;

/// How a flight in closed loop ended.
enum class FlightEnd {
  kFlown,   ///< to the mission's end
  kStruck,  ///< it touched something
  kAstray,  ///< it was kAstray_m off what the mission asked for
  kCut      ///< the run ended before
};
inline constexpr double kAstray_m = 10.0;

/// A flight in closed loop, judged by the truth.
struct FlightRecord {
  std::vector<Eigen::Vector3d> waypoints;  ///< of the mission, world [m]
  std::vector<FlightSample> samples;       ///< 10 ms apart, from when the craft left its pad
  FlightEnd end = FlightEnd::kCut;
};

/// Everything that a run leaves behind, before it is judged.
struct RunRecord {
  std::vector<PoseTrack::Stamped> ground_truth;  ///< world_from_body at every IMU stamp
  std::vector<PoseTrack::Stamped> estimate;      ///< as first given out, one per IMU sample
  std::vector<Odometry> odometry;                ///< the same with covariances; `health` moved out
  std::vector<ModuleHealth> health;              ///< of all modules in time order
  std::map<Module, MessageTally> messages;
  std::vector<TimingRow> timing;
  std::vector<FrameSnapshot> snapshots;  ///< three frames: a sixth, a half and five sixths through the run
  std::vector<MapPoint> map;             ///< in the estimate's world
  std::string prior_map;                 ///< path of the map that the run was localized on; empty: none
  std::vector<MapMatch> map_matches;     ///< with it, in time order
  std::optional<FlightRecord> flight;    ///< of a run in closed loop
  bool estimator_lost = false;           ///< the estimator said so in its last output
  std::string fault;                     ///< empty, or what ended the run early
  double estimator_wall_s = 0.0;
  double sensors_wall_s = 0.0;
};

}  // namespace plumbline
