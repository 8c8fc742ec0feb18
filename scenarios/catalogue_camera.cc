#include "scenarios/catalogue.h"
#include "scenarios/catalogue_file.h"
#include "scenarios/read_camera.h"

namespace plumbline {
namespace {

void read_chip(ConfigReader& reader, SensorChip& chip) {
  reader.read("electrons_per_dn", chip.electrons_per_dn, {0.1, 1e4});
  reader.read("read_noise_electrons", chip.read_noise_electrons, {0.0, 1e4});
  reader.read("dark_current_electrons_per_s", chip.dark_current_electrons_per_s, {0.0, 1e6});
  reader.read("full_well_electrons", chip.full_well_electrons, {100.0, 1e7});
  reader.read("electrons_per_lux_second", chip.electrons_per_lux_second, {1.0, 1e8});
  reader.read("black_level_dn", chip.black_level_dn, {0.0, 100.0});
}

void read_exposure(ConfigReader& reader, ExposureControl& control) {
  read_scaled(reader, "min_exposure_us", kMicro, control.min_exposure_s, {1.0, 1e6});
  read_scaled(reader, "max_exposure_ms", kMilli, control.max_exposure_s, {0.01, 1e4});
  read_scaled(reader, "row_time_us", kMicro, control.row_time_s, {0.0, 1e4});
  reader.read("max_gain", control.max_gain, {1.0, 100.0});
  reader.read("gain_step", control.gain_step, {0.0, 1.0});
  reader.read("target_dn", control.target_dn, {1.0, 254.0});
}

}  // namespace

CameraModel catalogue_camera(const std::string& name) {
  CameraModel model;
  model.name = name;
  read_device(name, "camera", [&](ConfigReader& reader) {
    reader.read("width", model.width, {16.0, 8192.0});
    reader.read("height", model.height, {16.0, 8192.0});
    reader.read("colour", model.colour);
    reader.read("horizontal_fov_deg", model.horizontal_fov_deg, {1.0, 170.0});
    reader.read("rate_hz", model.rate_hz, {0.1, 1000.0});
    reader.read("f_number", model.f_number, {0.5, 64.0});
    read_lens_and_shutter(reader, model);
    read_chip(reader, model.chip);
    read_exposure(reader, model.exposure);
  });
  return model;
}

DepthCameraModel catalogue_depth_camera(const std::string& name) {
  DepthCameraModel model;
  model.name = name;
  read_device(name, "depth_camera", [&](ConfigReader& reader) {
    reader.read("width", model.width, {16.0, 8192.0});
    reader.read("height", model.height, {16.0, 8192.0});
    reader.read("horizontal_fov_deg", model.horizontal_fov_deg, {1.0, 170.0});
    reader.read("rate_hz", model.rate_hz, {0.1, 1000.0});
    reader.read("baseline_m", model.baseline_m, {0.001, 1.0});
    reader.read("disparity_step_px", model.disparity_step_px, {1e-4, 1.0});
    reader.read("disparity_sigma_px", model.disparity_sigma_px, {0.0, 10.0});
    reader.read("min_range_m", model.min_range_m, {0.01, 10.0});
    reader.read("max_range_m", model.max_range_m, {0.1, 100.0});
    reader.read("edge_px", model.edge_px, {0.0, 20.0});
  });
  return model;
}

}  // namespace plumbline
