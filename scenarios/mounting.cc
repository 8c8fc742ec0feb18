#include "scenarios/mounting.h"

#include <cmath>

#include "sim/constants.h"

namespace plumbline {

Pose read_mounting(ConfigReader& reader, Eigen::Vector3d position) {
  constexpr Range kOffset_m{-10.0, 10.0};
  constexpr Range kAngle_deg{-180.0, 180.0};
  Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
  reader.read("x_m", position.x(), kOffset_m);
  reader.read("y_m", position.y(), kOffset_m);
  reader.read("z_m", position.z(), kOffset_m);
  reader.read("roll_deg", rpy_deg.x(), kAngle_deg);
  reader.read("pitch_deg", rpy_deg.y(), kAngle_deg);
  reader.read("yaw_deg", rpy_deg.z(), kAngle_deg);
  return {rotation_from_rpy(rpy_deg * kDegree), position};
}

}  // namespace plumbline
