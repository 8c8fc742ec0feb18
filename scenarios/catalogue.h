#pragma once

#include <string>
#include <vector>

#include "sensors/camera_model.h"
#include "sensors/depth_camera.h"
#include "sensors/imu.h"
#include "sensors/lidar.h"

namespace plumbline {

/// A device of sensors/catalogue.
struct CatalogueEntry {
  std::string name;
  std::string kind;  ///< lidar, camera, depth_camera or imu
  std::string summary;
};

/// All devices, by name.
std::vector<CatalogueEntry> sensor_catalogue();

/// Names of the devices of a kind, in order.
std::vector<std::string> catalogue_names(const std::string& kind);

/// Models as their files describe them. @throws InputError for a name that is not in the catalogue, or a bad file.
LidarModel catalogue_lidar(const std::string& name);
CameraModel catalogue_camera(const std::string& name);
DepthCameraModel catalogue_depth_camera(const std::string& name);
ImuModel catalogue_imu(const std::string& name);

}  // namespace plumbline
