#pragma once

#include <cstdint>
#include <map>
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
  bool estimator_lost = false;           ///< the estimator said so in its last output
  std::string fault;                     ///< empty, or what ended the run early
  double estimator_wall_s = 0.0;
  double sensors_wall_s = 0.0;
};

}  // namespace plumbline
