#include "tools/formats/kitti_folder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "scenarios/input_error.h"
#include "tools/formats/kitti_stamps.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr double kUsualSweep_s = 0.10315;  // mean of a raw drive's
constexpr double kLeastImuRate_hz = 50.0;  // OXTS of synchronised drives comes at 10 Hz: truth, but no IMU
constexpr std::int64_t kLongestSweep_ns = 2'000'000'000;  // a point's offset is 32 bits wide

template <typename T>
const T& at_number(const std::vector<T>& list, std::int64_t number, const fs::path& list_path) {
  if (number < static_cast<std::int64_t>(list.size())) return list[static_cast<std::size_t>(number)];
  throw InputError(list_path.string() + ": found " + std::to_string(list.size()) +
                   " lines, but there is a file number " + std::to_string(number));
}

using TimeScan = std::function<void(KittiScan&)>;  // sets a scan's span by its number

std::vector<KittiScan> read_scan_list(const fs::path& path) {
  std::vector<KittiScan> spans;
  TextTable table(path);
  while (table.next()) {
    spans.push_back({{}, 0, table.seconds_as_ns(0), table.seconds_as_ns(1), table.whole(2), table.whole(3) != 0});
  }
  return spans;
}

TimeScan times_of_list(const fs::path& list) {
  return [spans = read_scan_list(list), list](KittiScan& scan) {
    KittiScan span = at_number(spans, scan.number, list);
    span.path = scan.path;
    span.number = scan.number;
    scan = std::move(span);
  };
}

TimeScan times_of_spans(const fs::path& starts, const fs::path& ends) {
  return [first = read_kitti_stamps(starts), last = read_kitti_stamps(ends), starts, ends](KittiScan& scan) {
    scan.start_ns = at_number(first, scan.number, starts);
    scan.end_ns = at_number(last, scan.number, ends);
  };
}

TimeScan times_of_middles(const fs::path& list, std::int64_t before_ns, std::int64_t after_ns) {
  return [middles = read_kitti_stamps(list), list, before_ns, after_ns](KittiScan& scan) {
    const std::int64_t middle_ns = at_number(middles, scan.number, list);
    scan.start_ns = middle_ns - before_ns;
    scan.end_ns = middle_ns + after_ns;
  };
}

/// Where nothing tells the times, sweeps stand back to back.
TimeScan times_by_number(std::int64_t sweep_ns, std::int64_t span_ns) {
  return [sweep_ns, span_ns](KittiScan& scan) {
    scan.end_ns = (scan.number + 1) * sweep_ns;
    scan.start_ns = scan.end_ns - span_ns;
  };
}

TimeScan times_in(const KittiFolder& folder, const fs::path& scans, const DatasetSettings& settings) {
  const auto sweep_ns = static_cast<std::int64_t>(std::llround(1e9 * settings.sweep_s.value_or(kUsualSweep_s)));
  if (folder.is_ours) return times_of_list(folder.path / "scans.txt");
  const fs::path starts = scans.parent_path() / "timestamps_start.txt";
  if (scans != folder.path && fs::exists(starts) && !folder.compensated) {
    return times_of_spans(starts, scans.parent_path() / "timestamps_end.txt");
  }
  const fs::path middles = first_that_exists({scans.parent_path() / "timestamps.txt", folder.path / "times.txt"});
  // Motion-compensated points stand at one moment, which a span of a nanosecond says.
  if (middles.empty()) return times_by_number(sweep_ns, folder.compensated ? 1 : sweep_ns);
  if (folder.compensated) return times_of_middles(middles, 1, 0);
  return times_of_middles(middles, sweep_ns / 2, sweep_ns - sweep_ns / 2);
}

void find_scans(KittiFolder& folder, const DatasetSettings& settings) {
  const fs::path& path = folder.path;
  const fs::path scans = first_that_exists({path / "velodyne_points" / "data", path / "velodyne", path});
  const bool is_odometry = scans == path / "velodyne";
  folder.is_ours = fs::exists(path / "scans.txt");
  folder.compensated = settings.point_times == PointTimes::kNone ||
                       (settings.point_times == PointTimes::kFile && is_odometry && !folder.is_ours);
  const auto files = numbered_files(scans, {".bin", ".pcd"});
  if (files.empty()) return;
  const TimeScan take_time = times_in(folder, scans, settings);
  for (const NumberedFile& file : files) {
    KittiScan scan;
    scan.path = file.path;
    scan.number = scan.sweep = file.number;
    take_time(scan);
    const std::int64_t span_ns = scan.end_ns - scan.start_ns;
    if (span_ns <= 0 || span_ns > kLongestSweep_ns) {
      throw InputError(file.path.string() + ": its scan takes " + std::to_string(span_ns) +
                       " ns, allowed are up to 2 s");
    }
    folder.scans.push_back(scan);
  }
}

/// The camera is triggered when the lidar faces forward.
std::int64_t time_of_loose_image(const KittiFolder& folder, const NumberedFile& image) {
  const auto scan = std::find_if(folder.scans.begin(), folder.scans.end(),
                                 [&](const KittiScan& s) { return s.number == image.number; });
  if (scan == folder.scans.end()) {
    throw InputError(image.path.string() + ": has neither a time nor a scan of its number");
  }
  return folder.compensated ? scan->end_ns : scan->middle_ns();
}

void find_images(KittiFolder& folder, int camera) {
  const std::string digit = std::to_string(camera);
  const fs::path& path = folder.path;
  const fs::path images = first_that_exists({path / ("image_0" + digit) / "data", path / ("image_" + digit)});
  auto& found = folder.images[static_cast<std::size_t>(camera)];
  if (images.empty()) {
    if (camera > 0) return;
    for (const NumberedFile& file : numbered_files(path, {".png"})) {
      found.push_back({file.path, time_of_loose_image(folder, file)});
    }
    return;
  }
  const fs::path list = first_that_exists(
      {path / ("image_" + digit + "_times.txt"), images.parent_path() / "timestamps.txt", path / "times.txt"});
  if (list.empty()) throw InputError(images.string() + ": no file tells the images' times");
  const std::vector<std::int64_t> stamps = read_kitti_stamps(list);
  for (const NumberedFile& file : numbered_files(images, {".png"})) {
    found.push_back({file.path, at_number(stamps, file.number, list)});
  }
}

ImuSample sample_of(const TextTable& table, std::int64_t stamp_ns, std::size_t rate_at, std::size_t force_at) {
  ImuSample sample;
  sample.stamp_ns = stamp_ns;
  for (std::size_t i = 0; i < 3; ++i) {
    sample.angular_rate[static_cast<int>(i)] = table.number(rate_at + i);
    sample.specific_force[static_cast<int>(i)] = table.number(force_at + i);
  }
  return sample;
}

/// The development kit's Mercator projection; roll, pitch, yaw of the body axes.
/// @param scale  the cosine of the drive's first latitude
Pose oxts_pose(const TextTable& table, double scale) {
  constexpr double kEarth_m = 6378137.0;
  constexpr double kRadian = std::numbers::pi / 180.0;
  const Eigen::Vector3d position(scale * kEarth_m * table.number(1) * kRadian,
                                 scale * kEarth_m * std::log(std::tan((90.0 + table.number(0)) * kRadian / 2.0)),
                                 table.number(2));
  return {rotation_from_rpy({table.number(3), table.number(4), table.number(5)}), position};
}

void read_oxts(KittiFolder& folder) {
  const fs::path list = folder.path / "oxts" / "timestamps.txt";
  const std::vector<std::int64_t> stamps = read_kitti_stamps(list);
  double scale = 0.0;
  for (const NumberedFile& file : numbered_files(folder.path / "oxts" / "data", {".txt"})) {
    TextTable table(file.path);
    if (!table.next()) throw InputError(file.path.string() + ": is empty");
    const std::int64_t stamp_ns = at_number(stamps, file.number, list);
    if (!(std::abs(table.number(0)) < 89.0)) table.reject("the latitude is not between -89 and 89 degrees");
    if (scale == 0.0) scale = std::cos(table.number(0) * std::numbers::pi / 180.0);
    // Raw drives hold a few stamps that go back.
    if (folder.oxts_poses.empty() || stamp_ns > folder.oxts_poses.back().stamp_ns) {
      folder.oxts_poses.push_back({stamp_ns, oxts_pose(table, scale)});
    }
    folder.imu.push_back(sample_of(table, stamp_ns, 17, 11));
  }
  if (rate_of(folder.imu) < kLeastImuRate_hz) folder.imu.clear();
}

void find_imu(KittiFolder& folder) {
  if (fs::exists(folder.path / "imu.txt")) {
    TextTable table(folder.path / "imu.txt");
    while (table.next()) folder.imu.push_back(sample_of(table, table.seconds_as_ns(0), 1, 4));
  } else if (fs::exists(folder.path / "oxts" / "data")) {
    read_oxts(folder);
  }
}

}  // namespace

fs::path first_that_exists(const std::vector<fs::path>& candidates) {
  std::error_code error;
  for (const fs::path& path : candidates) {
    if (fs::exists(path, error)) return path;
  }
  return {};
}

fs::path KittiFolder::calibration_file(const char* name) const {
  return first_that_exists({path / name, path / ".." / name});
}

KittiFolder read_kitti_folder(const fs::path& path, const DatasetSettings& settings) {
  std::error_code error;
  if (!fs::is_directory(path, error)) throw InputError(path.string() + ": no such folder");
  KittiFolder folder;
  folder.path = path;
  find_scans(folder, settings);
  for (const int camera : {0, 1}) find_images(folder, camera);
  find_imu(folder);
  if (folder.scans.empty() && folder.images[0].empty()) {
    throw InputError(path.string() + ": holds no scans (velodyne_points/data, velodyne, or loose .bin or .pcd files)");
  }
  return folder;
}

}  // namespace plumbline
