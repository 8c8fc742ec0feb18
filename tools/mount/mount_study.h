#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/sweep_file.h"

namespace plumbline {

/// What a mounting may cost before it is ruled out.
struct MountLimits {
  double own_body_share = 1.0;  ///< of the lidar's firings, or of the image, that the vehicle may take up
  double overlap = 0.0;         ///< of the image that the lidar must see as well
};

/// How much each figure counts when mountings are put in order; 0: not at all.
struct MountWeights {
  double drift = 1.0;
  double worst_direction = 0.25;
  double coverage = 0.25;
  double degenerate_time = 0.25;
};

/// Which mountings the second stage tries.
struct MountTrial {
  int mountings = 12;
  bool spread = false;  ///< evenly over the first stage's order, worst included, in place of the best
};

/// A study file, read and checked.
struct MountStudy {
  std::string name;  ///< the file's stem
  std::filesystem::path path;
  std::vector<std::filesystem::path> scenarios;
  SweepFile runs;  ///< its axes are the rig's free angles and offsets; its scenario is left open
  MountLimits limits;
  MountWeights weights;
  MountTrial trial;
  std::string judged;                 ///< the estimator whose drift counts; the others are shown beside it
  std::vector<std::string> surfaces;  ///< materials that matter for coverage; empty: all
};

/// Keys: scenarios [FILE, ...], vehicle NAME (in place of the scenarios' own), mount {KEY: values as a sweep's axis},
/// each KEY one of {x,y,z}_m and {roll,pitch,yaw}_deg under rig, rig.lidar or rig.camera; sample, set, seeds and
/// estimators as in a sweep; limits {own_body_share, overlap, time_s, memory_mb}; weigh {drift, worst_direction,
/// coverage, degenerate_time}; surfaces [MATERIAL, ...]; trial {mountings, choose: best | spread}. Of several
/// estimators the scenario's own is judged, if it is among them.
/// @throws InputError for anything missing, malformed, unknown or twice
MountStudy read_mount_study(const std::filesystem::path& path);

}  // namespace plumbline
