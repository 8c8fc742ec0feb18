#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/random_stream.h"
#include "sim/world.h"

namespace plumbline {

/// The middle of a road or path, by its distance s from the start [m]. Places beside it have an offset n to the left
/// and a height `up` above it; on a closed line s may be any number.
class RoadLine {
 public:
  /// @param samples  1 m apart along x, y
  RoadLine(std::vector<Eigen::Vector3d> samples, bool closed);

  double length() const { return length_; }
  bool closed() const { return closed_; }
  Eigen::Vector3d at(double s) const;
  double heading(double s) const;  ///< from the x axis towards y, continuous
  Eigen::Vector3d place(double s, double n, double up = 0.0) const;
  /// x along the line, z up, turned by yaw.
  Pose frame(double s, double n, double up = 0.0, double yaw = 0.0) const;

 private:
  std::pair<std::size_t, double> cell(double s) const;

  std::vector<Eigen::Vector3d> samples_;
  std::vector<double> headings_;
  double length_;
  bool closed_;
};

/// How a line winds. Its heading stays within heading_limit, so that it never meets itself. A line of the same plan and
/// seed begins as any shorter one does.
struct Winding {
  double length_m = 100.0;
  double min_radius_m = 60.0;
  double max_radius_m = 250.0;
  double heading_limit = 1.0;
  double shortest_straight_m = 50.0;
  double longest_straight_m = 250.0;
  double easing_m = 20.0;  ///< over which the curvature changes
};

/// @param height  of the line at s
RoadLine winding_line(const Winding& plan, RandomStream stream, const std::function<double(double s)>& height);

/// A closed line through the corners of a polygon, rounded by `radius_m`, scaled to be length_m long.
RoadLine closed_line(std::vector<Eigen::Vector2d> corners, double radius_m, double length_m,
                     const std::function<double(const Eigen::Vector2d&)>& height);

/// A route `n` to the left of a line, its points `spacing_m` apart; `height_above` is added to the line's height.
Route route_beside(const RoadLine& line, const std::string& name, double from_s, double to_s, double n,
                   const std::function<double(double s)>& height_above, double spacing_m = 4.0);

}  // namespace plumbline
