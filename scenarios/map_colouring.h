#pragma once

#include <vector>

#include "scenarios/run_record.h"
#include "scenarios/scenario.h"
#include "sensors/sensor_chip.h"
#include "sim/surroundings.h"
#include "sim/trajectory.h"

namespace plumbline {

/// A colour camera's frame and where the estimate says it was taken.
struct ColourView {
  const RawImage& raw;
  double black_level_dn = 0.0;
  CameraIntrinsics intrinsics;
  Pose map_from_camera;
};

/// Gives map points the colours of one frame. A point counts as seen if it lies in the image and not behind others: not
/// more than 10 % and 0.2 m deeper than the nearest point of its neighbourhood in the image. Of several frames the one
/// from nearest by decides.
class MapColouring {
 public:
  /// The points must outlive this.
  explicit MapColouring(std::vector<MapPoint>& points);
  void add(const ColourView& view);

 private:
  std::vector<MapPoint>& points_;
  std::vector<float> nearest_m_;  ///< depth at which each point was coloured
};

/// After a run: takes the colour camera's frames along the true motion and colours the record's map by them, from the
/// poses that the estimator gave. Without a colour camera it does nothing.
void colour_map(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body,
                RunRecord& record);

}  // namespace plumbline
