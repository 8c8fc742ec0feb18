#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <stdexcept>

#include "estimator/estimator.h"

namespace plumbline {

void write_ply(const std::string& path, const std::vector<MapPoint>& points) {
  pcl::PointCloud<pcl::PointXYZI> cloud;
  cloud.reserve(points.size());
  for (const MapPoint& point : points) {
    pcl::PointXYZI p;
    p.getVector3fMap() = point.position;
    p.intensity = point.intensity;
    cloud.push_back(p);
  }
  // The camera element that PCL adds by default confuses other readers.
  pcl::PLYWriter writer;
  if (writer.write(path, cloud, /*binary=*/true, /*use_camera=*/false) != 0) {
    throw std::runtime_error(path + ": cannot be written");
  }
}

}  // namespace plumbline
