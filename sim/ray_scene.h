#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "sim/ray_hit.h"
#include "sim/ray_packet.h"
#include "sim/world.h"

namespace plumbline {

class RaySurfaces;
class RayScene;

/// The surfaces near a place, at about one time: a part of a RayScene, which must outlive it.
class RayWindow {
 public:
  /// Rays may start this far from the window's place, and be cast this long before or after its time.
  static constexpr double kSlack_m = 10.0;
  static constexpr double kSlack_s = 0.5;

  /// As RayScene::cast.
  RayHit cast(const Eigen::Vector3d& origin_in_world, const Eigen::Vector3d& direction_in_world, double min_range_m,
              double max_range_m, double time_s) const;
  /// The same for each of a packet's rays, and the same hits.
  void cast(const RayPacket& rays, double min_range_m, double max_range_m,
            std::array<RayHit, RayPacket::kMost>& hits) const;

 private:
  friend class RayScene;
  struct NearMover;

  /// Both put a nearer hit in the place of `best`.
  void cast_on_planes(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double min_range_m,
                      RayHit& best) const;
  void cast_on_movers(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double min_range_m,
                      double time_s, RayHit& best) const;

  const RayScene* scene_ = nullptr;
  std::shared_ptr<const RaySurfaces> standing_;
  std::vector<NearMover> movers_;

 public:
  RayWindow();
  RayWindow(const RayWindow&);
  RayWindow& operator=(const RayWindow&);
  ~RayWindow();
};

/// The world's copy for ray casting, on Embree. Rays see every geom type as MuJoCo's mj_ray does; the rig body's geoms
/// and geoms that are fully transparent are left out, as mj_ray leaves them out.
class RayScene {
 public:
  explicit RayScene(const World& world);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// What rays of at most reach_m, starting within RayWindow::kSlack_m of `place`, can hit. Sensors take one window a
  /// sweep and cast through it: its cost, and a ray's, follow from what is near, not from the size of the world. Safe
  /// to call from several threads at once; the same arguments give the same hits, whatever was asked before.
  RayWindow window(const Eigen::Vector3d& place, double reach_m, double time_s = 0.0) const;

  /// The first surface along a ray within [min_range_m, max_range_m], with the movers where they are at `time_s`. Safe
  /// to call from several threads at once; many rays from about one place are cheaper through a window.
  /// @param direction_in_world  unit length
  RayHit cast(const Eigen::Vector3d& origin_in_world, const Eigen::Vector3d& direction_in_world, double min_range_m,
              double max_range_m, double time_s = 0.0) const;

  /// Distance from a point to the nearest surface that stands still, at most limit_m: the measure of a map's error.
  double distance_to_surface(const Eigen::Vector3d& point_in_world, double limit_m) const;

 private:
  friend class RayWindow;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline
