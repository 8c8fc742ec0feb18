#pragma once

#include <cstdint>
#include <vector>

#include "sim/scenes/ribbon.h"
#include "sim/scenes/road_line.h"

namespace plumbline {

enum class District { kTown, kSuburb, kWorks, kFields, kWood };

/// A stretch of street of one kind.
struct Stretch {
  double from_s = 0.0;
  double to_s = 0.0;
  District district = District::kTown;
};

/// Something at one place of the street; half_m to either side of s is its own.
struct Feature {
  enum class Kind { kValleyBridge, kOverpass, kCrossing };
  Kind kind = Kind::kCrossing;
  double s = 0.0;
  double half_m = 0.0;
  double depth_m = 0.0;  ///< of a bridged valley
};

/// What lies where along a street: its line, districts, bridges and crossings, and so its ground. A longer street of
/// the same seed begins as a shorter one does.
class StreetPlan {
 public:
  static constexpr double kLane_m = 3.5;  ///< width of each of two lanes
  static constexpr double kHalfWidth_m = 55.0;

  static constexpr double kRow_m = 2.5;  ///< between sections as laid

  /// @param rural_share  of the districts
  StreetPlan(double length_m, double rural_share, std::uint64_t seed);

  const RoadLine& line() const { return line_; }
  const std::vector<Stretch>& stretches() const { return stretches_; }
  const std::vector<Feature>& features() const { return features_; }
  const Stretch& stretch_at(double s) const;
  /// Whether a bridge, an underpass or a crossing lies within `margin_m` of a stretch of road.
  bool is_kept_free(double from_s, double to_s, double margin_m) const;

  double road_half(double s) const;       ///< from the middle to the kerb
  double pavement_width(double s) const;  ///< beyond the kerb
  double valley_depth(double s) const;    ///< of the ground below the line, where a bridge carries the road
  const Feature* bridge_at(double s) const;

  Section section(double s) const;
  Eigen::Vector3d ground(double s, double n) const { return line_.place(s, n, section(s).up_at(n)); }
  /// An upright frame on the ground, x along the road, turned by yaw.
  Pose stand(double s, double n, double yaw) const;

 private:
  double blend(double s, double (*value)(District)) const;
  double relief(double s, double n) const;
  const Feature* crossing_at(double s) const;

  std::uint64_t seed_;
  RoadLine line_;
  std::vector<Stretch> stretches_;
  std::vector<Feature> features_;
};

bool is_rural(District district);

}  // namespace plumbline
