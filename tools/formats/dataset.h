#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimator/messages.h"
#include "scenarios/config_node.h"
#include "scenarios/recording.h"

/// Recorded data of any format, in and out.
namespace plumbline {

/// What a dataset gives. Its body is the IMU; without one, the lidar, and without that, the camera turned upright.
struct Dataset {
  Calibration calibration;
  Recording recording;
  bool has_imu = true;  ///< false: the IMU's samples are zeros and only a clock
};

/// How the times of a scan's points are found where the format does not carry them.
enum class PointTimes {
  kFile,     ///< from a file beside the points if there is one, else as the format's files usually are
  kAzimuth,  ///< a head that turns clockwise, from the rear
  kNone      ///< the points are motion-compensated: all at one time
};

struct RosTopics {
  std::string imu = "/imu";
  std::string camera = "/camera";
  std::string right_camera = "/right_camera";
  std::string depth = "/depth";
  std::string lidar = "/lidar";
  std::string truth = "/truth";
};

/// What a replay is told besides the dataset itself.
struct DatasetSettings {
  std::string lidar_model;  ///< of the catalogue: rings, range noise and limits, and the device that rings are told by
  std::string imu_model;    ///< of the catalogue: noise
  PointTimes point_times = PointTimes::kFile;
  std::optional<double> sweep_s;  ///< a revolution's time where the files do not say; otherwise the format's usual
  double clock_hz = 100.0;        ///< of the clock that stands in for a missing IMU
  RosTopics topics;
  ConfigNode calibration;       ///< keys of calibration.yaml laid over the dataset's own; a map, or nothing
  std::filesystem::path truth;  ///< a file of its own, instead of the dataset's; empty: none
};

/// Opens a dataset; messages are read as they are asked for.
/// @throws InputError naming the file and what is wrong with it, now or when the message is asked for
Dataset open_dataset(const std::string& format, const std::filesystem::path& path, const DatasetSettings& settings);

/// Takes a session's messages in order of delivery. Messages that a format cannot hold are left out.
class DatasetWriter {
 public:
  virtual ~DatasetWriter() = default;
  /// @throws std::runtime_error if a file cannot be written
  virtual void write(const SensorMessage& message) = 0;
  /// Writes what comes last. @param truth  world_from_body in time order, empty if unknown
  virtual void finish(const std::vector<PoseTrack::Stamped>& truth) = 0;
};

/// @param directory  exists and is empty
std::unique_ptr<DatasetWriter> make_dataset_writer(const std::string& format, const std::filesystem::path& directory,
                                                   const Calibration& calibration);

/// Their names.
const std::vector<std::string>& dataset_formats();

}  // namespace plumbline
