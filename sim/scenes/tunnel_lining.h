#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/geometry/pose.h"
#include "sim/scenes/mjcf_writer.h"
#include "sim/scenes/tunnel_line.h"

namespace plumbline {

struct TunnelPlan {
  TunnelLine line{0.0, 0.0};
  double half_width = 0.0;
  double height = 0.0;
  bool round = false;
  double roughness = 0.0;  ///< rms of the lining's relief
  double rib_spacing = 0.0;
  double rib_depth = 0.0;
  double lamp_spacing = 0.0;
  double axis_facing = 0.0;  ///< share of a lidar's returns [0, 1]
  std::uint64_t seed = 0;
};

/// A flat strip of the lining or road, all along the tunnel: seen in the section, y to the left and z up.
struct TunnelStrip {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double tilt = 0.0;  ///< about x; at 0 the strip faces up
  double width = 0.0;
  double overlap = 0.0;   ///< beyond each of its edges, behind the neighbouring strips' faces
  double shortest = 4.0;  ///< stretches of one material
  double longest = 8.0;
  std::vector<std::string> materials;
  std::string name;  ///< of its random stream

  /// In the section: along the strip's width, and away from its face.
  Eigen::Vector2d across() const;
  Eigen::Vector2d normal() const;
};

/// The strip's own frame in the tunnel's: its face at z = 0, looking up along z; y across.
Pose frame_of(const TunnelStrip& strip);

/// Walls and ceiling, smooth: neighbours share edges.
std::vector<TunnelStrip> tunnel_lining(const TunnelPlan& plan);
std::vector<TunnelStrip> tunnel_road(const TunnelPlan& plan);

/// Lays lining and road all along the tunnel, straight smooth stretches as boxes, the bend and rough walls as meshes.
void add_lining(MjcfWriter& writer, const TunnelPlan& plan, const std::vector<TunnelStrip>& lining);
void add_road(MjcfWriter& writer, const TunnelPlan& plan);

}  // namespace plumbline
