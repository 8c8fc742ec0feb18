#include "tools/formats/dataset.h"

#include <map>

#include "scenarios/input_error.h"
#include "tools/formats/calibration_yaml.h"
#include "tools/formats/dataset_calibration.h"
#include "tools/formats/euroc.h"
#include "tools/formats/kitti.h"
#include "tools/formats/output_file.h"
#include "tools/formats/plumbline_dataset.h"
#include "tools/formats/ros_dataset.h"
#include "tools/formats/tum_rgbd.h"

namespace plumbline {
namespace {

struct Format {
  Dataset (*open)(const std::filesystem::path&, const DatasetSettings&);
  std::unique_ptr<DatasetWriter> (*make_writer)(const std::filesystem::path&, const Calibration&);
};

const std::map<std::string, Format>& formats() {
  static const std::map<std::string, Format> known{
      {"euroc", {open_euroc, make_euroc_writer}},
      {"kitti", {open_kitti, make_kitti_writer}},
      {"plumbline", {open_plumbline_dataset, make_plumbline_writer}},
      {"rosbag", {open_rosbag, make_rosbag_writer}},
      {"rosbag2", {open_rosbag2, make_rosbag2_writer}},
      {"tum", {open_tum_rgbd, make_tum_rgbd_writer}},
  };
  return known;
}

const Format& format_named(const std::string& name) {
  const auto found = formats().find(name);
  if (found != formats().end()) return found->second;
  throw InputError("--format: found '" + name + "', expected one of the names in --help");
}

}  // namespace

Dataset open_dataset(const std::string& format, const std::filesystem::path& path, const DatasetSettings& settings) {
  return format_named(format).open(path, settings);
}

std::unique_ptr<DatasetWriter> make_dataset_writer(const std::string& format, const std::filesystem::path& directory,
                                                   const Calibration& calibration) {
  auto writer = format_named(format).make_writer(directory, calibration);
  write_whole_file(directory / kDatasetCalibration, calibration_yaml(calibration));
  return writer;
}

const std::vector<std::string>& dataset_formats() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, format] : formats()) all.push_back(name);
    return all;
  }();
  return names;
}

}  // namespace plumbline
