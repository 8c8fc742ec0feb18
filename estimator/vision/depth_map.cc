#include "estimator/vision/depth_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <nanoflann.hpp>

#include "estimator/geometry/interpolation.h"
#include "estimator/vision/lens_pixels.h"

namespace plumbline {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr int kNeighbours = 16;                // enough to reach a second ring past the points of the first
constexpr double kSpreadShare = 0.1;           // thesis 5.2: no plane across objects; limit as method section 8
constexpr double kSpreadFloor = 0.3;           // [m]
constexpr double kLeastCosine = 0.15;          // between plane normal and ray: 81 degrees of incidence
constexpr double kLeastDepth = 0.1;            // [m]
constexpr double kMaxOutside = 0.5 * kDegree;  // how far outside its triangle a ray may pass on a lone surface
constexpr double kRegistrationAngle = 2e-3;    // [rad], of points registered with the estimate's own motion
constexpr double kCurvatureShare = 0.05;       // of the triangle's depth spread, for surfaces that are not planes
constexpr double kInsertionMargin = 30.0 * kDegree;
constexpr std::size_t kMaxScans = 64;
/// Of depth cameras that project a pattern, measured on the Kinect: Khoshelham and Elberink, Sensors 12, 2012.
constexpr DepthNoise kDepthImageNoise{0.0, 1.43e-3};

/// Points as the tree wants them: azimuth and polar angle in the camera, and the position they belong to.
struct AngularPoints {
  std::vector<Eigen::Vector2f> angles;
  std::vector<Eigen::Vector3f> positions;
  std::vector<DepthSource> sources;

  std::size_t kdtree_get_point_count() const { return angles.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const { return angles[i][static_cast<Eigen::Index>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using AngularTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, AngularPoints>,
                                                        AngularPoints, 2, std::uint32_t>;

/// Azimuth is scaled by nothing: within 35 degrees of the axis the metric is off by less than a fifth.
Eigen::Vector2f angles_of(const Eigen::Vector3f& p) {
  return {std::atan2(p.x(), p.z()), std::atan2(p.y(), std::hypot(p.x(), p.z()))};
}

float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Neighbour {
  Eigen::Vector2f angle;  ///< relative to the ray
  Eigen::Vector3f position;
  DepthSource source = DepthSource::kLidar;
};

/// Whether the ray, at the angular origin, passes through the triangle.
bool encloses(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  const float s1 = cross(a, b);
  const float s2 = cross(b, c);
  const float s3 = cross(c, a);
  return (s1 > 0 && s2 > 0 && s3 > 0) || (s1 < 0 && s2 < 0 && s3 < 0);
}

/// A triangle so thin that its plane is anyone's guess: three points of one ring.
bool is_sliver(const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  const float longest = std::max({(a - b).squaredNorm(), (b - c).squaredNorm(), (c - a).squaredNorm()});
  return std::abs(cross(b - a, c - a)) < 0.2F * longest;
}

struct Triangle {
  std::array<Neighbour, 3> corners;
  bool encloses_ray = false;
};

/// The nearest neighbour, and the nearest two that make a triangle around the ray with it; failing that, one beside it.
std::optional<Triangle> choose_triangle(const std::vector<Neighbour>& sorted) {
  std::optional<Triangle> beside;
  const Neighbour& a = sorted.front();
  for (std::size_t k = 2; k < sorted.size(); ++k) {
    for (std::size_t j = 1; j < k; ++j) {
      const Neighbour& b = sorted[j];
      const Neighbour& c = sorted[k];
      if (is_sliver(a.angle, b.angle, c.angle)) continue;
      if (encloses(a.angle, b.angle, c.angle)) return Triangle{{a, b, c}, true};
      if (!beside) beside = Triangle{{a, b, c}, false};
    }
  }
  return beside;
}

float spread_of(const Triangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  return std::max(
      {(a.position - b.position).norm(), (b.position - c.position).norm(), (c.position - a.position).norm()});
}

float depth_spread_of(const Triangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  const auto [low, high] = std::minmax({a.position.z(), b.position.z(), c.position.z()});
  return high - low;
}

double spread_limit(double depth) { return std::max(kSpreadFloor, kSpreadShare * depth); }

}  // namespace

struct DepthMap::Impl {
  struct Scan {
    std::int64_t stamp_ns = 0;
    DepthSource source = DepthSource::kLidar;
    std::vector<Eigen::Vector3f> points_in_world;
  };

  CameraIntrinsics camera;
  PixelBounds bounds;
  DepthMapConfig config;
  std::deque<Scan> scans;  // oldest first
  AngularPoints view;
  std::unique_ptr<AngularTree> tree;
  std::vector<std::uint8_t> cell_taken;  // one flag per angular cell of the view
  mutable std::vector<Neighbour> neighbours;
  mutable std::vector<Neighbour> nearer_surface;

  void drop_older_than(std::int64_t now_ns) {
    while (!scans.empty() && seconds_between(scans.front().stamp_ns, now_ns) > config.max_age_s) scans.pop_front();
  }
  void gather_view(const Pose& world_from_camera);
  void find_neighbours(const Eigen::Vector3f& ray) const;
  std::optional<MapDepth> intersect(const Triangle& triangle, const Eigen::Vector3d& ray) const;
};

DepthMap::DepthMap(const CameraIntrinsics& camera, const DepthMapConfig& config) : impl_(std::make_unique<Impl>()) {
  impl_->camera = camera;
  impl_->bounds = pinhole_bounds(camera);
  impl_->config = config;
}
DepthMap::DepthMap(DepthMap&&) noexcept = default;
DepthMap& DepthMap::operator=(DepthMap&&) noexcept = default;
DepthMap::~DepthMap() = default;

void DepthMap::add(std::int64_t stamp_ns, DepthSource source, const std::vector<Eigen::Vector3f>& points_in_world,
                   const std::optional<Pose>& world_from_camera) {
  Impl::Scan scan{stamp_ns, source, {}};
  scan.points_in_world.reserve(points_in_world.size());
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();
  float least_cosine = -1.0F;
  if (world_from_camera) {
    const auto& c = impl_->camera;
    const Eigen::Vector2d extent = impl_->bounds.most - impl_->bounds.least;
    const double half_diagonal = std::atan(std::hypot(0.5 * extent.x() / c.fx, 0.5 * extent.y() / c.fy));
    origin = world_from_camera->translation.cast<float>();
    axis = (world_from_camera->rotation * Eigen::Vector3d::UnitZ()).cast<float>();
    least_cosine = static_cast<float>(std::cos(std::min(M_PI, half_diagonal + kInsertionMargin)));
  }
  for (const Eigen::Vector3f& p : points_in_world) {
    const Eigen::Vector3f beam = p - origin;
    if (p.allFinite() && axis.dot(beam) >= least_cosine * beam.norm()) scan.points_in_world.push_back(p);
  }
  impl_->scans.push_back(std::move(scan));
  if (impl_->scans.size() > kMaxScans) impl_->scans.pop_front();
}

void DepthMap::look_from(const Pose& world_from_camera, std::int64_t now_ns) {
  impl_->drop_older_than(now_ns);
  impl_->gather_view(world_from_camera);
  impl_->tree.reset();
  if (!impl_->view.angles.empty()) {
    impl_->tree = std::make_unique<AngularTree>(2, impl_->view, nanoflann::KDTreeSingleIndexAdaptorParams(10));
  }
}

void DepthMap::Impl::gather_view(const Pose& world_from_camera) {
  view.angles.clear();
  view.positions.clear();
  view.sources.clear();
  const double cell = std::tan(config.angular_spacing_deg * kDegree);
  const double margin = std::tan(config.max_neighbour_angle_deg * kDegree);
  const double left = (bounds.least.x() - camera.cx) / camera.fx - margin;
  const double top = (bounds.least.y() - camera.cy) / camera.fy - margin;
  const Eigen::Vector2d extent = bounds.most - bounds.least;
  const int columns = static_cast<int>((extent.x() / camera.fx + 2.0 * margin) / cell) + 1;
  const int rows = static_cast<int>((extent.y() / camera.fy + 2.0 * margin) / cell) + 1;
  cell_taken.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);

  const Pose camera_from_world = world_from_camera.inverse();
  const Eigen::Matrix3f rotation = camera_from_world.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f origin = world_from_camera.translation.cast<float>();
  const auto cells_per_unit = static_cast<float>(1.0 / cell);
  const auto left_f = static_cast<float>(left);
  const auto top_f = static_cast<float>(top);
  for (auto scan = scans.rbegin(); scan != scans.rend(); ++scan) {
    for (const Eigen::Vector3f& point : scan->points_in_world) {
      const Eigen::Vector3f p = rotation * (point - origin);
      if (!(p.z() > static_cast<float>(kLeastDepth))) continue;
      const float inverse_z = 1.0F / p.z();
      const float column = (p.x() * inverse_z - left_f) * cells_per_unit;
      const float row = (p.y() * inverse_z - top_f) * cells_per_unit;
      if (column < 0 || row < 0 || column >= static_cast<float>(columns) || row >= static_cast<float>(rows)) continue;
      const auto index =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
      if (cell_taken[index] != 0) continue;
      cell_taken[index] = 1;
      view.angles.push_back(angles_of(p));
      view.positions.push_back(p);
      view.sources.push_back(scan->source);
    }
  }
}

/// The nearest points within the angular limit, sorted by angle.
void DepthMap::Impl::find_neighbours(const Eigen::Vector3f& ray) const {
  neighbours.clear();
  const Eigen::Vector2f angle = angles_of(ray);
  std::array<std::uint32_t, kNeighbours> indices{};
  std::array<float, kNeighbours> squared{};
  const std::size_t found = tree->knnSearch(angle.data(), kNeighbours, indices.data(), squared.data());
  const auto limit = static_cast<float>(config.max_neighbour_angle_deg * kDegree);
  for (std::size_t i = 0; i < found && squared[i] <= limit * limit; ++i) {
    const std::uint32_t k = indices[i];
    neighbours.push_back({view.angles[k] - angle, view.positions[k], view.sources[k]});
  }
}

std::optional<MapDepth> DepthMap::depth_along(const Eigen::Vector3d& ray) const {
  if (!impl_->tree) return std::nullopt;
  impl_->find_neighbours(ray.cast<float>());
  const std::vector<Neighbour>& all = impl_->neighbours;
  if (all.size() < 3) return std::nullopt;

  float nearest = all.front().position.z();
  for (const Neighbour& n : all) nearest = std::min(nearest, n.position.z());
  std::vector<Neighbour>& near = impl_->nearer_surface;
  near.clear();
  for (const Neighbour& n : all) {
    if (n.position.z() <= nearest + spread_limit(nearest)) near.push_back(n);
  }
  if (near.size() < 3) return std::nullopt;
  const bool mixed = near.size() < all.size();
  const std::optional<Triangle> triangle = choose_triangle(near);
  if (!triangle) return std::nullopt;
  // Beside a lone surface a short extrapolation is fair; between two surfaces nothing says which one the ray meets.
  if (!triangle->encloses_ray && (mixed || near.front().angle.norm() > static_cast<float>(kMaxOutside))) {
    return std::nullopt;
  }
  return impl_->intersect(*triangle, ray);
}

/// z = X_1 . n / (X-bar . n), thesis 3.10.
std::optional<MapDepth> DepthMap::Impl::intersect(const Triangle& triangle, const Eigen::Vector3d& ray) const {
  const auto& [a, b, c] = triangle.corners;
  const Eigen::Vector3d p = a.position.cast<double>();
  const Eigen::Vector3d normal =
      (b.position - a.position).cast<double>().cross((c.position - a.position).cast<double>()).normalized();
  const double along = ray.dot(normal);
  const double cosine = std::abs(along) / ray.norm();
  if (!(cosine > kLeastCosine)) return std::nullopt;
  const double depth = p.dot(normal) / along;
  if (!(depth > kLeastDepth)) return std::nullopt;
  if (spread_of(triangle) > spread_limit(depth)) return std::nullopt;

  const double tangent = std::sqrt(1.0 - std::min(1.0, cosine * cosine)) / cosine;
  const DepthNoise& noise = a.source == DepthSource::kLidar ? config.lidar : kDepthImageNoise;
  const double sigma = std::sqrt(std::pow(noise.at(depth), 2) + std::pow(depth * kRegistrationAngle * tangent, 2) +
                                 std::pow(kCurvatureShare * static_cast<double>(depth_spread_of(triangle)), 2));
  return MapDepth{{1.0 / depth, sigma / (depth * depth)}, normal / p.dot(normal), a.source};
}

std::size_t DepthMap::points_in_view() const { return impl_->view.angles.size(); }

}  // namespace plumbline
