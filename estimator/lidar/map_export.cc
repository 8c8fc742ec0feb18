#include <pcl/PCLPointCloud2.h>
#include <pcl/common/io.h>
#include <pcl/conversions.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "estimator/estimator.h"

namespace plumbline {
namespace {

void write_empty_ply(const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
          "property float z\nproperty float intensity\nproperty float normal_x\nproperty float normal_y\n"
          "property float normal_z\nend_header\n";
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

/// One field or several beside those that a cloud already has.
void add_fields(const pcl::PCLPointCloud2& further, pcl::PCLPointCloud2& cloud) {
  pcl::PCLPointCloud2 joined;
  pcl::concatenateFields(cloud, further, joined);
  cloud = std::move(joined);
}

/// Positions and intensities.
pcl::PCLPointCloud2 plain_cloud(const std::vector<MapPoint>& points) {
  pcl::PointCloud<pcl::PointXYZI> cloud;
  cloud.reserve(points.size());
  for (const MapPoint& point : points) {
    pcl::PointXYZI p;
    p.getVector3fMap() = point.position;
    p.intensity = point.intensity;
    cloud.push_back(p);
  }
  pcl::PCLPointCloud2 fields;
  pcl::toPCLPointCloud2(cloud, fields);
  return fields;
}

pcl::PCLPointCloud2 normal_cloud(const std::vector<MapPoint>& points) {
  pcl::PointCloud<pcl::Axis> cloud;
  cloud.reserve(points.size());
  for (const MapPoint& point : points) cloud.push_back({point.normal.x(), point.normal.y(), point.normal.z()});
  pcl::PCLPointCloud2 fields;
  pcl::toPCLPointCloud2(cloud, fields);
  return fields;
}

pcl::PCLPointCloud2 colour_cloud(const std::vector<MapPoint>& points) {
  constexpr std::uint8_t kUnseen = 128;
  pcl::PointCloud<pcl::RGB> cloud;
  cloud.reserve(points.size());
  for (const MapPoint& point : points) {
    pcl::RGB p;
    p.r = point.coloured ? point.colour[0] : kUnseen;
    p.g = point.coloured ? point.colour[1] : kUnseen;
    p.b = point.coloured ? point.colour[2] : kUnseen;
    cloud.push_back(p);
  }
  pcl::PCLPointCloud2 fields;
  pcl::toPCLPointCloud2(cloud, fields);
  return fields;
}

}  // namespace

void write_ply(const std::string& path, const std::vector<MapPoint>& points) {
  // PCL refuses to write a cloud without points; a run without scan matching has just that.
  if (points.empty()) return write_empty_ply(path);
  pcl::PCLPointCloud2 cloud = plain_cloud(points);
  add_fields(normal_cloud(points), cloud);
  if (std::any_of(points.begin(), points.end(), [](const MapPoint& point) { return point.coloured; })) {
    add_fields(colour_cloud(points), cloud);
  }
  // The camera element that PCL adds by default confuses other readers.
  pcl::PLYWriter writer;
  if (writer.write(path, cloud, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity(), /*binary=*/true,
                   /*use_camera=*/false) != 0) {
    throw std::runtime_error(path + ": cannot be written");
  }
}

}  // namespace plumbline
