#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>

#include "estimator/geometry/pose.h"
#include "estimator/localization/prior_map.h"

namespace plumbline {

struct CloudPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float intensity = 0.0F;
};

struct CloudHeader {
  bool has_normals = false;
  std::optional<Pose> site_from_cloud;  ///< see write_place_on_site()
};

/// Who is told of a cloud as it is read: first what it has, then each of its points.
struct CloudListener {
  std::function<void(const CloudHeader&)> header;
  std::function<void(const CloudPoint&)> point;
};

/// Reads a .ply (ascii or binary, of either byte order) or a .pcd (ascii, binary or binary_compressed) point by point,
/// with any fields besides x, y and z; normal_x, normal_y, normal_z (or nx, ny, nz) and intensity are used. What it
/// holds in memory does not depend on the number of points, but for binary_compressed, which is refused beyond 1 GB.
/// @throws InputError naming the file, what was found and what is allowed
void read_point_cloud(const std::filesystem::path& path, const CloudListener& listener);

/// A map to localize on.
struct SitedMap {
  PriorMap map;
  std::optional<Pose> site_from_map;  ///< if it says where it lies on its site
};
/// @throws InputError, also for a map without usable points
SitedMap read_prior_map(const std::filesystem::path& path);

/// Says in a PLY where it lies on its site, in a header line that other readers skip:
/// `comment site_from_cloud X Y Z QX QY QZ QW`. @throws std::runtime_error if the file cannot be written
void write_place_on_site(const std::filesystem::path& ply, const Pose& site_from_cloud);

}  // namespace plumbline
