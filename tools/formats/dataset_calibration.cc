#include "tools/formats/dataset_calibration.h"

#include "scenarios/catalogue.h"
#include "scenarios/input_error.h"
#include "scenarios/yaml_reader.h"
#include "tools/formats/calibration_yaml.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

constexpr std::uintmax_t kMostOwnBytes = 1'000'000;

void take_devices(const DatasetSettings& settings, Calibration& calibration) {
  if (!settings.lidar_model.empty()) {
    const LidarModel lidar = catalogue_lidar(settings.lidar_model);
    calibration.lidar_rings = ring_count(lidar);
    calibration.lidar_range_sigma_m = lidar.accuracy_sigma_m;
    calibration.lidar_min_range_m = lidar.min_range_m;
    calibration.lidar_max_range_m = lidar.max_range_m;
  }
  if (!settings.imu_model.empty()) calibration.imu = catalogue_imu(settings.imu_model).noise;
}

}  // namespace

Calibration complete_calibration(const Calibration& native, const std::filesystem::path& folder,
                                 const DatasetSettings& settings) {
  Calibration calibration = native;
  const std::filesystem::path own = folder / kDatasetCalibration;
  std::error_code error;
  if (!folder.empty() && std::filesystem::exists(own, error)) {
    calibration = read_calibration_yaml(read_bounded_file(own, kMostOwnBytes), own.string());
  }
  take_devices(settings, calibration);
  if (!settings.calibration.is_map()) return calibration;
  const ConfigNode keys = read_yaml_text(calibration_yaml(calibration), folder.string(), folder);
  return read_calibration_yaml(canonical_yaml(merged(keys, settings.calibration)),
                               settings.calibration.where + ", laid over what the dataset says");
}

}  // namespace plumbline
