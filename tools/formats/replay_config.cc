#include "tools/formats/replay_config.h"

#include "scenarios/catalogue.h"
#include "scenarios/scenario_files.h"
#include "scenarios/schema.h"

namespace plumbline {
namespace {

void read_device(ConfigReader& reader, const std::string& kind, std::string& model) {
  const std::vector<std::string> names = catalogue_names(kind);
  std::size_t index = 0;
  if (reader.read_choice(kind + "_model", names, index)) model = names[index];
}

void read_topics(ConfigReader& reader, RosTopics& topics) {
  reader.read("imu", topics.imu);
  reader.read("camera", topics.camera);
  reader.read("right_camera", topics.right_camera);
  reader.read("depth", topics.depth);
  reader.read("lidar", topics.lidar);
  reader.read("truth", topics.truth);
}

void read_dataset(ConfigReader& reader, DatasetSettings& settings) {
  read_device(reader, "lidar", settings.lidar_model);
  read_device(reader, "imu", settings.imu_model);
  static const std::vector<std::string> kPointTimes{"file", "azimuth", "none"};
  std::size_t index = 0;
  if (reader.read_choice("point_times", kPointTimes, index)) settings.point_times = static_cast<PointTimes>(index);
  double sweep_s = 0.0;
  if (reader.read("sweep_s", sweep_s, {0.005, 2.0})) settings.sweep_s = sweep_s;
  reader.read("clock_hz", settings.clock_hz, {1.0, 2000.0});
  reader.section("topics", [&](ConfigReader& topics) { read_topics(topics, settings.topics); });
  if (const ConfigNode* calibration = reader.find("calibration")) {
    if (!calibration->is_map()) fail_at(*calibration, reader.path_of("calibration"), "a map of keys");
    settings.calibration = *calibration;
  }
}

std::string name_of(const std::filesystem::path& dataset) {
  const std::filesystem::path normal = std::filesystem::absolute(dataset).lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).filename().string();
}

}  // namespace

ReplayConfig read_replay_config(const std::filesystem::path& dataset, const std::filesystem::path& file,
                                const std::vector<std::string>& overrides) {
  const ConfigNode keys = read_scenario_files(file, overrides);
  ReplayConfig config;
  Scenario& scenario = config.scenario;
  scenario.name = name_of(dataset);
  scenario.path = dataset;
  ConfigReader reader(keys, "");
  reader.section("dataset", [&](ConfigReader& section) { read_dataset(section, config.dataset); });
  reader.section("estimator", [&](ConfigReader& estimator) {
    read_estimator(estimator, scenario.estimator_name, scenario.estimator_directory, scenario.estimator);
  });
  reader.section("expect", [&](ConfigReader& expect) { read_expect(expect, scenario.expect, scenario.expect_status); });
  reader.finish();
  scenario.resolved_yaml = canonical_yaml(keys);
  scenario.digest = digest_of(scenario.resolved_yaml);
  return config;
}

std::string replay_keys_help() {
  return R"(Keys of --config and --set, besides estimator.* and expect.* as in a scenario:
  dataset.calibration.*    laid over what the dataset says of its sensors; the keys are those of the calibration.yaml
                           that every export holds, e.g. dataset.calibration.lidar.range_sigma_m=0.02
  dataset.lidar_model      a device of `plumbline list sensors`: rings, range noise and limits (kitti: hdl64e)
  dataset.imu_model        likewise: noise
  dataset.point_times      file: as the files say, or as the format's usually are (default); azimuth: a head that turns
                           clockwise from the rear; none: the points are motion-compensated
  dataset.sweep_s          time of a revolution where nothing tells it (kitti: 0.10315)
  dataset.clock_hz         rate of the outputs where there is no IMU (100)
  dataset.topics.*         imu, camera, right_camera, depth, lidar, truth: of bags; /imu, /camera, … by default
)";
}

}  // namespace plumbline
