#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "tools/formats/dataset.h"
#include "tools/formats/recorded_files.h"

namespace plumbline {

struct KittiScan {
  std::filesystem::path path;
  std::int64_t number = 0;  ///< in its name
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t sweep = 0;
  bool ends_sweep = true;

  std::int64_t middle_ns() const { return start_ns + (end_ns - start_ns) / 2; }
};

/// The files of one drive or sequence and their times.
struct KittiFolder {
  std::filesystem::path path;
  bool is_ours = false;      ///< written by us: scans.txt tells the spans
  bool compensated = false;  ///< the points of a scan are of one time, its end
  std::vector<KittiScan> scans;
  std::array<std::vector<StampedFile>, 2> images;  ///< by camera
  std::vector<ImuSample> imu;                      ///< empty if it is too slow to be one
  std::vector<PoseTrack::Stamped> oxts_poses;      ///< of the IMU, in a world that begins at sea

  /// A file of the folder, or of the one above, where a raw drive's calibration lies; empty if there is none.
  std::filesystem::path calibration_file(const char* name) const;
};

/// @throws InputError if it holds neither scans nor images, or files and times do not agree
KittiFolder read_kitti_folder(const std::filesystem::path& path, const DatasetSettings& settings);

/// The first of some paths that is there, or an empty one.
std::filesystem::path first_that_exists(const std::vector<std::filesystem::path>& candidates);

}  // namespace plumbline
