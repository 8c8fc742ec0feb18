#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <fstream>
#include <stdexcept>

#include "estimator/estimator.h"

namespace plumbline {
namespace {

void write_empty_ply(const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
          "property float z\nproperty float intensity\nend_header\n";
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace

void write_ply(const std::string& path, const std::vector<MapPoint>& points) {
  pcl::PointCloud<pcl::PointXYZI> cloud;
  cloud.reserve(points.size());
  for (const MapPoint& point : points) {
    pcl::PointXYZI p;
    p.getVector3fMap() = point.position;
    p.intensity = point.intensity;
    cloud.push_back(p);
  }
  // PCL refuses to write a cloud without points; a run without scan matching has just that.
  if (points.empty()) return write_empty_ply(path);
  // The camera element that PCL adds by default confuses other readers.
  pcl::PLYWriter writer;
  if (writer.write(path, cloud, /*binary=*/true, /*use_camera=*/false) != 0) {
    throw std::runtime_error(path + ": cannot be written");
  }
}

}  // namespace plumbline
