#pragma once

#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/ray_scene.h"
#include "sim/surroundings.h"
#include "sim/trajectory.h"

namespace plumbline {

/// What a mounting promises, told by rays along the path alone: no estimator, no noise, no picture.
struct MountPrediction {
  /// Growth of the position's error if every new sight is registered as well as the Cramer-Rao bound of lidar and image
  /// together allows, % of the path: good for putting mountings in order, not as a figure of its own.
  double drift_percent = 0.0;
  double worst_direction = 0.0;  ///< of scans: the bound's standard deviation over its limit, 90th percentile
  double degenerate_time = 0.0;  ///< share of scans with a degenerate direction
  double coverage = 0.0;         ///< share of the surfaces about the path that the lidar sees
  double own_body_share = 0.0;   ///< of the lidar's firings, or of the image if that is more
  double overlap = 0.0;          ///< share of the image's surfaces that the lidar sees as well
};

/// What lidar and camera see from one place, as pictures of ranges; 0: nothing.
struct MountView {
  struct Picture {
    int width = 0;
    int height = 0;
    std::vector<float> range_m;     ///< row-major, the top row first
    std::vector<float> brightness;  ///< [0, 1], albedo lit from the camera's place; negative: the vehicle's own body
  };
  Picture lidar;  ///< all round in the lidar's frame: columns from straight behind clockwise, rows by elevation
  Picture camera;
};

/// The world, path and vehicle of a scenario, which all its mountings share.
class MountPredictor {
 public:
  /// @param scenario  whose mounting does not matter
  /// @param surfaces  materials that count for coverage; empty: all
  /// @throws InputError for a scenario that cannot be simulated or a material that it does not have
  MountPredictor(const Scenario& scenario, const std::vector<std::string>& surfaces);

  /// @param rig  of the same scenario, mounted otherwise
  MountPrediction predict(const RigConfig& rig);
  /// From the middle of the path.
  MountView view(const RigConfig& rig);

 private:
  using Cell = std::tuple<int, int, int>;
  /// A place on the path, and the stretch that it stands for.
  struct Place {
    std::int64_t stamp_ns = 0;     ///< a sweep begins
    std::int64_t sweep = 0;        ///< index of the sweep
    PoseTrack world_from_vehicle;  ///< over the sweep
    double step_m = 0.0;
  };
  struct Sight;

  void choose_places(const Trajectory& world_from_vehicle, const RigConfig& rig);
  void find_surfaces(const RigConfig& rig, const std::vector<std::string>& materials);
  /// As it stands to a pack mounted so; nullptr: none.
  const OwnBody* own_body(const RigConfig& rig);
  Sight look(const Place& place, const RigConfig& rig);
  void look_with_lidar(const Place& place, const RigConfig& rig, Sight& sight);
  void look_with_camera(const Place& place, const RigConfig& rig, Sight& sight);
  static Cell cell_of(const Eigen::Vector3d& point_in_world);

  World world_;
  RayScene rays_;
  std::unique_ptr<OwnBody> own_body_;
  std::vector<Place> places_;
  std::set<Cell> surfaces_;
};

}  // namespace plumbline
