#include "scenarios/map_colouring.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/camera_on_rig.h"

namespace plumbline {
namespace {

constexpr int kCell_px = 16;  // of the neighbourhoods: wide enough that a wall's points, some 0.2 m apart, close it
constexpr float kFar = std::numeric_limits<float>::infinity();

/// Linear light in [0, 1] as an sRGB byte (IEC 61966-2-1).
std::uint8_t srgb(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  const double encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

struct Sighting {
  std::size_t point = 0;
  int u = 0;
  int v = 0;
  float depth_m = 0.0F;
};

/// The points that fall into the image, whatever hides them.
std::vector<Sighting> sightings(const std::vector<MapPoint>& points, const ColourView& view) {
  const CameraIntrinsics& c = view.intrinsics;
  const Pose camera_from_map = view.map_from_camera.inverse();
  std::vector<Sighting> seen;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = camera_from_map * points[i].position.cast<double>();
    if (p.z() < 0.1) continue;
    const Eigen::Vector2d ideal(p.x() / p.z(), p.y() / p.z());
    if (ideal.norm() > 2.0 * c.width / c.fx) continue;  // where a lens's polynomial may fold back
    const Eigen::Vector2d place = distort(c.distortion, ideal);
    const auto u = static_cast<int>(std::lround(c.fx * place.x() + c.cx));
    const auto v = static_cast<int>(std::lround(c.fy * place.y() + c.cy));
    if (u < 0 || v < 0 || u >= c.width || v >= c.height) continue;
    seen.push_back({i, u, v, static_cast<float>(p.z())});
  }
  return seen;
}

/// The least depth in and around every cell of the image.
class NearestDepths {
 public:
  NearestDepths(const CameraIntrinsics& camera, const std::vector<Sighting>& seen)
      : columns_(camera.width / kCell_px + 1),
        rows_(camera.height / kCell_px + 1),
        depth_m_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kFar) {
    for (const Sighting& s : seen) {
      float& depth = depth_m_[index(s.u / kCell_px, s.v / kCell_px)];
      depth = std::min(depth, s.depth_m);
    }
  }

  float around(int u, int v) const {
    float least = kFar;
    for (int row = std::max(v / kCell_px - 1, 0); row <= std::min(v / kCell_px + 1, rows_ - 1); ++row) {
      for (int column = std::max(u / kCell_px - 1, 0); column <= std::min(u / kCell_px + 1, columns_ - 1); ++column) {
        least = std::min(least, depth_m_[index(column, row)]);
      }
    }
    return least;
  }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  int columns_;
  int rows_;
  std::vector<float> depth_m_;
};

std::array<std::uint8_t, 3> colour_at(const ColourView& view, int u, int v) {
  const std::size_t pixel =
      static_cast<std::size_t>(v) * static_cast<std::size_t>(view.raw.width) + static_cast<std::size_t>(u);
  const double black = 4.0 * view.black_level_dn;
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    colour[c] = srgb((view.raw.counts[3 * pixel + c] - black) / (RawImage::kMostCounts - black));
  }
  return colour;
}

/// Where the estimator said that the body was.
PoseTrack estimated_track(const RunRecord& record) {
  PoseTrack track;
  for (const auto& stamped : record.estimate) track.push(stamped.stamp_ns, stamped.pose);
  return track;
}

}  // namespace

MapColouring::MapColouring(std::vector<MapPoint>& points) : points_(points), nearest_m_(points.size(), kFar) {}

void MapColouring::add(const ColourView& view) {
  const std::vector<Sighting> seen = sightings(points_, view);
  const NearestDepths nearest(view.intrinsics, seen);
  for (const Sighting& s : seen) {
    if (s.depth_m >= nearest_m_[s.point] || s.depth_m > 1.1F * nearest.around(s.u, s.v) + 0.2F) continue;
    nearest_m_[s.point] = s.depth_m;
    points_[s.point].coloured = true;
    points_[s.point].colour = colour_at(view, s.u, s.v);
  }
}

void colour_map(const Scenario& scenario, const Surroundings& surroundings, const Trajectory& world_from_body,
                RunRecord& record) {
  if (!scenario.rig.colour_camera || record.map.empty() || record.estimate.empty()) return;
  const MountedCamera& mounted = *scenario.rig.colour_camera;
  RigDriver driver(world_from_body);
  Camera camera(mounted.model, mounted.effects, scenario.seed, "colour camera noise");
  Renderer renderer(surroundings.world, camera.view(),
                    {.threads = 0, .depth = false, .colour = true, .own_body = surroundings.own_body});
  CameraOnRig on_rig({scenario, surroundings, driver}, mounted.pack_from_camera, std::move(camera), renderer);

  const PoseTrack map_from_body = estimated_track(record);
  MapColouring colouring(record.map);
  const std::int64_t period_ns = std::llround(1e9 / mounted.model.rate_hz);
  std::int64_t frame = 0;
  for (std::int64_t stamp_ns = period_ns / 2; map_from_body.covers(stamp_ns); stamp_ns += period_ns) {
    const RawImage raw = on_rig.take(stamp_ns, frame++);
    colouring.add({raw, mounted.model.chip.black_level_dn, intrinsics_of(mounted.model, mounted.effects),
                   map_from_body.at(stamp_ns) * mounted.pack_from_camera});
    driver.forget_before(stamp_ns);
  }
}

}  // namespace plumbline
