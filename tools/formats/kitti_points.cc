#include "tools/formats/kitti_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>

#include "scenarios/input_error.h"
#include "tools/formats/point_cloud_file.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

static_assert(std::endian::native == std::endian::little, "fields are copied as they stand in memory");

// 8 million points; the densest head gives a quarter of a million.
constexpr std::uintmax_t kMostScanBytes = std::uintmax_t{128} << 20;
constexpr std::size_t kMostPoints = 8'000'000;
constexpr float kFurthest_m = 1e4F;
constexpr std::size_t kBinPointBytes = 16;

// Azimuth falls from 360 to 0 degrees where a ring ends. Motion compensation moves points across the seam and back:
// a rise of nearly a turn is a step back across it.
constexpr double kNewRingFall = 0.5 * std::numbers::pi;
constexpr double kSeamRise = 5.0 / 3.0 * std::numbers::pi;

double azimuth(const LidarPoint& point) {
  return std::atan2(static_cast<double>(point.position.y()), static_cast<double>(point.position.x()));
}

/// From 0 to 2 pi.
double full_azimuth(const LidarPoint& point) {
  const double angle = azimuth(point);
  return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
}

void add_point(const float (&xyzi)[4], std::vector<LidarPoint>& points) {
  LidarPoint point;
  point.position = {xyzi[0], xyzi[1], xyzi[2]};
  point.intensity = std::isfinite(xyzi[3]) ? xyzi[3] : 0.0F;
  points.push_back(point);
}

std::vector<LidarPoint> points_of_bin(const std::filesystem::path& path, const std::string& bytes) {
  if (bytes.size() % kBinPointBytes != 0) {
    throw InputError(path.string() + ": found " + std::to_string(bytes.size()) +
                     " bytes, expected a multiple of 16 (x, y, z, intensity as float32)");
  }
  std::vector<LidarPoint> points;
  points.reserve(bytes.size() / kBinPointBytes);
  for (std::size_t at = 0; at < bytes.size(); at += kBinPointBytes) {
    float xyzi[4];
    std::memcpy(xyzi, bytes.data() + at, kBinPointBytes);
    add_point(xyzi, points);
  }
  return points;
}

std::vector<LidarPoint> points_of_pcd(const std::filesystem::path& path) {
  std::vector<LidarPoint> points;
  const auto take = [&](const CloudPoint& point) {
    if (points.size() == kMostPoints) throw InputError(path.string() + ": found more than 8 million points");
    const Eigen::Vector3f position = point.position.cast<float>();
    add_point({position.x(), position.y(), position.z(), point.intensity}, points);
  };
  read_point_cloud(path, {[](const CloudHeader& /*header*/) {}, take});
  return points;
}

}  // namespace

std::vector<LidarPoint> read_kitti_points(const std::filesystem::path& path) {
  return path.extension() == ".pcd" ? points_of_pcd(path)
                                    : points_of_bin(path, read_bounded_file(path, kMostScanBytes));
}

void drop_unusable(std::vector<LidarPoint>& points) {
  std::erase_if(points, [](const LidarPoint& point) {
    const Eigen::Vector3f& p = point.position;
    return !p.allFinite() || p.cwiseAbs().maxCoeff() > kFurthest_m || p.isZero(0.0F);
  });
}

void assign_rings_by_azimuth(int rings, std::vector<LidarPoint>& points) {
  int below_top = 0;
  double previous = 0.0;
  for (LidarPoint& point : points) {
    double angle = full_azimuth(point);
    if (angle - previous > kSeamRise) angle -= 2.0 * std::numbers::pi;
    if (previous - angle > kNewRingFall) ++below_top;
    previous = angle;
    point.ring = below_top < rings ? static_cast<std::uint16_t>(rings - 1 - below_top) : UINT16_MAX;
  }
  std::erase_if(points, [](const LidarPoint& point) { return point.ring == UINT16_MAX; });
}

void assign_times_by_azimuth(std::int64_t duration_ns, std::vector<LidarPoint>& points) {
  const auto last_ns = static_cast<double>(std::max<std::int64_t>(duration_ns - 1, 0));
  for (LidarPoint& point : points) {
    const double share = 0.5 - azimuth(point) / (2.0 * std::numbers::pi);
    point.offset_ns = static_cast<std::int32_t>(std::clamp(share * static_cast<double>(duration_ns), 0.0, last_ns));
  }
}

void sort_by_time(std::vector<LidarPoint>& points) {
  std::stable_sort(points.begin(), points.end(), [](const LidarPoint& a, const LidarPoint& b) {
    return a.offset_ns != b.offset_ns ? a.offset_ns < b.offset_ns : a.ring < b.ring;
  });
}

void sort_as_kitti(std::vector<LidarPoint>& points) {
  std::stable_sort(points.begin(), points.end(), [](const LidarPoint& a, const LidarPoint& b) {
    return a.ring != b.ring ? a.ring > b.ring : full_azimuth(a) < full_azimuth(b);
  });
}

std::string kitti_bin(const std::vector<LidarPoint>& points) {
  std::string bytes(points.size() * kBinPointBytes, '\0');
  std::size_t at = 0;
  for (const LidarPoint& point : points) {
    const float xyzi[4] = {point.position.x(), point.position.y(), point.position.z(), point.intensity};
    std::memcpy(bytes.data() + at, xyzi, kBinPointBytes);
    at += kBinPointBytes;
  }
  return bytes;
}

}  // namespace plumbline
