#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <utility>

#include "scenarios/input_error.h"
#include "scenarios/merged_source.h"
#include "tools/formats/clock_source.h"
#include "tools/formats/dataset_calibration.h"
#include "tools/formats/image_file.h"
#include "tools/formats/kitti.h"
#include "tools/formats/kitti_calibration.h"
#include "tools/formats/kitti_points.h"
#include "tools/formats/kitti_stamps.h"
#include "tools/formats/recorded_files.h"
#include "tools/formats/text_table.h"
#include "tools/formats/truth_file.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKittiLidar = "hdl64e";
constexpr double kKittiSweep_s = 0.10315;  // mean of a raw drive's
constexpr double kLeastImuRate_hz = 50.0;  // OXTS of synchronised drives comes at 10 Hz: truth, but no IMU
constexpr std::uintmax_t kMostSideFileBytes = std::uintmax_t{64} << 20;
constexpr std::int64_t kLongestSweep_ns = 2'000'000'000;  // a point's offset is 32 bits wide

struct ScanTime {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t sweep = 0;
  bool ends_sweep = true;
};

struct Scan {
  NumberedFile file;
  ScanTime time;
};

fs::path first_that_exists(const std::vector<fs::path>& candidates) {
  std::error_code error;
  for (const fs::path& path : candidates) {
    if (fs::exists(path, error)) return path;
  }
  return {};
}

template <typename T>
const T& at_number(const std::vector<T>& list, std::int64_t number, const fs::path& list_path) {
  if (number < static_cast<std::int64_t>(list.size())) return list[static_cast<std::size_t>(number)];
  throw InputError(list_path.string() + ": found " + std::to_string(list.size()) +
                   " lines, but there is a file number " + std::to_string(number));
}

/// The files of one drive or sequence and what they say.
class KittiFolder {
 public:
  KittiFolder(const fs::path& path, const DatasetSettings& settings) : path_(path), settings_(settings) {
    const bool is_ours = fs::exists(path / kDatasetCalibration);
    if (settings_.lidar_model.empty() && !is_ours) settings_.lidar_model = kKittiLidar;
    std::error_code error;
    if (!fs::is_directory(path, error)) throw InputError(path.string() + ": no such folder");
    find_scans();
    for (int camera = 0; camera < 2; ++camera) find_images(camera);
    find_imu();
    if (scans_.empty() && images_[0].empty()) {
      throw InputError(path.string() +
                       ": holds no scans (velodyne_points/data, velodyne, or loose .bin or .pcd files)");
    }
  }

  Dataset open() const {
    Dataset dataset;
    dataset.has_imu = !imu_.empty();
    dataset.calibration = calibration();
    dataset.recording.truth = truth(dataset.calibration);
    take_span(dataset.recording);
    MessageSource messages = merged_sources(merged_sources(frame_source(images_[0], 0), frame_source(images_[1], 1)),
                                            scans(dataset.calibration));
    dataset.recording.messages = dataset.has_imu ? merged_sources(imu_source(imu_), std::move(messages))
                                                 : with_clock(std::move(messages), settings_.clock_hz);
    return dataset;
  }

 private:
  bool compensated() const {
    if (settings_.point_times == PointTimes::kFile) return is_odometry_;
    return settings_.point_times == PointTimes::kNone;
  }

  void find_scans() {
    const fs::path folder = first_that_exists({path_ / "velodyne_points" / "data", path_ / "velodyne", path_});
    is_odometry_ = folder == path_ / "velodyne" || fs::exists(path_ / "times.txt");
    const auto files = numbered_files(folder, {".bin", ".pcd"});
    if (files.empty()) return;
    const auto time_of = scan_times(folder);
    for (const NumberedFile& file : files) scans_.push_back({file, time_of(file.number)});
    for (const Scan& scan : scans_) check_time(scan);
  }

  static void check_time(const Scan& scan) {
    const std::int64_t duration_ns = scan.time.end_ns - scan.time.start_ns;
    if (duration_ns > 0 && duration_ns <= kLongestSweep_ns) return;
    throw InputError(scan.file.path.string() + ": its scan takes " + std::to_string(duration_ns) +
                     " ns, allowed are up to 2 s");
  }

  std::function<ScanTime(std::int64_t)> scan_times(const fs::path& folder) const {
    const auto sweep_ns = static_cast<std::int64_t>(std::llround(1e9 * settings_.sweep_s.value_or(kKittiSweep_s)));
    const fs::path own = path_ / "scans.txt";
    const fs::path raw = folder.parent_path() / "timestamps_start.txt";
    const fs::path middles = first_that_exists({folder.parent_path() / "timestamps.txt", path_ / "times.txt"});
    if (fs::exists(own)) {
      return [times = read_scan_list(own), own](std::int64_t n) { return at_number(times, n, own); };
    }
    if (folder != path_ && fs::exists(raw)) {
      const fs::path ends = folder.parent_path() / "timestamps_end.txt";
      return [starts = read_kitti_stamps(raw), stops = read_kitti_stamps(ends), raw, ends](std::int64_t n) {
        return ScanTime{at_number(starts, n, raw), at_number(stops, n, ends), n, true};
      };
    }
    if (!middles.empty()) {
      // Motion-compensated points stand at one moment, which a scan's span of a nanosecond says.
      const std::int64_t before_ns = compensated() ? 1 : sweep_ns / 2;
      const std::int64_t after_ns = compensated() ? 0 : sweep_ns - sweep_ns / 2;
      return [stamps = read_kitti_stamps(middles), middles, before_ns, after_ns](std::int64_t n) {
        const std::int64_t middle_ns = at_number(stamps, n, middles);
        return ScanTime{middle_ns - before_ns, middle_ns + after_ns, n, true};
      };
    }
    const std::int64_t span_ns = compensated() ? 1 : sweep_ns;
    return [sweep_ns, span_ns](std::int64_t n) {
      return ScanTime{(n + 1) * sweep_ns - span_ns, (n + 1) * sweep_ns, n, true};
    };
  }

  static std::vector<ScanTime> read_scan_list(const fs::path& path) {
    std::vector<ScanTime> times;
    TextTable table(path);
    while (table.next()) {
      times.push_back({table.seconds_as_ns(0), table.seconds_as_ns(1), table.whole(2), table.whole(3) != 0});
    }
    return times;
  }

  void find_images(int camera) {
    const std::string digit = std::to_string(camera);
    const fs::path folder = first_that_exists({path_ / ("image_0" + digit) / "data", path_ / ("image_" + digit)});
    const bool loose = folder.empty() && camera == 0;
    const auto files =
        folder.empty() && !loose ? std::vector<NumberedFile>{} : numbered_files(loose ? path_ : folder, {".png"});
    const fs::path list = loose ? fs::path()
                                : first_that_exists({path_ / ("image_" + digit + "_times.txt"),
                                                     folder.parent_path() / "timestamps.txt", path_ / "times.txt"});
    const std::vector<std::int64_t> stamps = list.empty() ? std::vector<std::int64_t>{} : read_kitti_stamps(list);
    for (const NumberedFile& file : files) {
      const std::int64_t stamp_ns = list.empty() ? middle_of_scan(file) : at_number(stamps, file.number, list);
      images_[camera].push_back({file.path, stamp_ns});
    }
  }

  /// The camera is triggered when the lidar faces forward.
  std::int64_t middle_of_scan(const NumberedFile& image) const {
    const auto scan =
        std::find_if(scans_.begin(), scans_.end(), [&](const Scan& s) { return s.file.number == image.number; });
    if (scan == scans_.end()) throw InputError(image.path.string() + ": has neither a time nor a scan of its number");
    return compensated() ? scan->time.end_ns : scan->time.start_ns + (scan->time.end_ns - scan->time.start_ns) / 2;
  }

  void find_imu() {
    if (fs::exists(path_ / "imu.txt")) {
      TextTable table(path_ / "imu.txt");
      while (table.next()) add_sample(table, table.seconds_as_ns(0), 1, 4);
      return;
    }
    if (!fs::exists(path_ / "oxts" / "data")) return;
    const fs::path list = path_ / "oxts" / "timestamps.txt";
    const std::vector<std::int64_t> stamps = read_kitti_stamps(list);
    for (const NumberedFile& file : numbered_files(path_ / "oxts" / "data", {".txt"})) {
      TextTable table(file.path);
      if (!table.next()) throw InputError(file.path.string() + ": is empty");
      const std::int64_t stamp_ns = at_number(stamps, file.number, list);
      // Raw drives hold a few stamps that go back.
      if (oxts_poses_.empty() || stamp_ns > oxts_poses_.back().stamp_ns) add_oxts_pose(table, stamp_ns);
      add_sample(table, stamp_ns, 17, 11);
    }
    if (rate_of(imu_) < kLeastImuRate_hz) imu_.clear();
  }

  void add_sample(const TextTable& table, std::int64_t stamp_ns, std::size_t rate_at, std::size_t force_at) {
    ImuSample sample;
    sample.stamp_ns = stamp_ns;
    for (std::size_t i = 0; i < 3; ++i) {
      sample.angular_rate[static_cast<int>(i)] = table.number(rate_at + i);
      sample.specific_force[static_cast<int>(i)] = table.number(force_at + i);
    }
    imu_.push_back(sample);
  }

  /// The development kit's Mercator projection, scaled at the first latitude; roll, pitch, yaw of the body axes.
  void add_oxts_pose(const TextTable& table, std::int64_t stamp_ns) {
    constexpr double kEarth_m = 6378137.0;
    constexpr double kRadian = std::numbers::pi / 180.0;
    const double latitude = table.number(0);
    if (!(std::abs(latitude) < 89.0)) table.reject("the latitude is not between -89 and 89 degrees");
    if (oxts_poses_.empty()) mercator_scale_ = std::cos(latitude * kRadian);
    const double scale = mercator_scale_ * kEarth_m;
    const Eigen::Vector3d position(scale * table.number(1) * kRadian,
                                   scale * std::log(std::tan((90.0 + latitude) * kRadian / 2.0)), table.number(2));
    oxts_poses_.push_back(
        {stamp_ns, {rotation_from_rpy({table.number(3), table.number(4), table.number(5)}), position}});
  }

  Calibration calibration() const {
    Calibration calibration;
    calibration.has_lidar = !scans_.empty();
    take_rates(calibration);
    const Pose lidar_from_body = dataset_has_imu() ? lidar_from_imu() : Pose{};
    calibration.body_from_lidar = lidar_from_body.inverse();
    calibration.has_camera = !images_[0].empty() && take_cameras(lidar_from_body, calibration);
    return complete_calibration(calibration, path_, settings_);
  }

  bool dataset_has_imu() const { return !imu_.empty(); }

  void take_rates(Calibration& calibration) const {
    calibration.imu_rate_hz = dataset_has_imu() ? rate_of(imu_) : settings_.clock_hz;
    const auto rate = [](std::size_t count, std::int64_t span_ns) {
      return count > 1 && span_ns > 0 ? 1e9 * static_cast<double>(count - 1) / static_cast<double>(span_ns) : 10.0;
    };
    if (!scans_.empty()) {
      calibration.lidar_rate_hz = rate(scans_.size(), scans_.back().time.end_ns - scans_.front().time.end_ns);
    }
    if (!images_[0].empty()) {
      calibration.camera_rate_hz = rate(images_[0].size(), images_[0].back().stamp_ns - images_[0].front().stamp_ns);
    }
  }

  fs::path calibration_file(const char* name) const { return first_that_exists({path_ / name, path_ / ".." / name}); }

  Pose lidar_from_imu() const {
    const fs::path file = calibration_file("calib_imu_to_velo.txt");
    return file.empty() ? Pose{} : pose_of_parts(file);
  }

  /// A file of keys R and T.
  static Pose pose_of_parts(const fs::path& file) {
    const auto keys = read_kitti_keys(file);
    const auto r = keys.find("R");
    const auto t = keys.find("T");
    if (r == keys.end() || t == keys.end() || r->second.size() != 9 || t->second.size() != 3) {
      throw InputError(file.string() + ": expected R: with nine numbers and T: with three");
    }
    std::vector<double> rows;
    for (std::size_t row = 0; row < 3; ++row) {
      rows.insert(rows.end(), r->second.begin() + 3 * static_cast<long>(row),
                  r->second.begin() + 3 * static_cast<long>(row) + 3);
      rows.push_back(t->second[row]);
    }
    return kitti_pose(rows, file.string());
  }

  /// Camera 0's projection matrix and its place. Nothing if no file tells.
  struct Rectified {
    std::vector<double> projection[2];
    Pose camera_from_lidar;
  };

  std::optional<Rectified> rectified() const {
    const fs::path odometry = first_that_exists({path_ / "calib.txt"});
    const fs::path cameras = calibration_file("calib_cam_to_cam.txt");
    const fs::path lidar = calibration_file("calib_velo_to_cam.txt");
    Rectified result;
    if (!odometry.empty()) {
      const auto keys = read_kitti_keys(odometry);
      result.projection[0] = value_of(keys, "P0", odometry);
      result.projection[1] = value_of(keys, "P1", odometry);
      const char* name = keys.count("Tr") != 0 ? "Tr" : "Tr_velo_to_cam";
      result.camera_from_lidar = kitti_pose(value_of(keys, name, odometry), odometry.string() + ": " + name);
      return result;
    }
    if (cameras.empty() || lidar.empty()) return std::nullopt;
    const auto keys = read_kitti_keys(cameras);
    result.projection[0] = value_of(keys, "P_rect_00", cameras);
    result.projection[1] = value_of(keys, "P_rect_01", cameras);
    std::vector<double> rotation = value_of(keys, "R_rect_00", cameras);
    if (rotation.size() != 9) throw InputError(cameras.string() + ": R_rect_00: expected nine numbers");
    for (const long at : {3L, 7L, 11L}) rotation.insert(rotation.begin() + at, 0.0);
    result.camera_from_lidar = kitti_pose(rotation, cameras.string() + ": R_rect_00") * pose_of_parts(lidar);
    return result;
  }

  static std::vector<double> value_of(const std::map<std::string, std::vector<double>>& keys, const std::string& key,
                                      const fs::path& file) {
    const auto found = keys.find(key);
    if (found == keys.end()) throw InputError(file.string() + ": no numbers for " + key);
    return found->second;
  }

  bool take_cameras(const Pose& lidar_from_body, Calibration& calibration) const {
    const auto found = rectified();
    if (!found) return false;
    for (int camera = 0; camera < 2; ++camera) {
      const std::vector<double>& p = found->projection[camera];
      if (p.size() != 12 || !(p[0] > 0.0) || !(p[5] > 0.0)) {
        throw InputError(path_.string() + ": the calibration's P" + std::to_string(camera) +
                         " is no projection matrix");
      }
      if (images_[camera].empty()) continue;
      const CameraFrame first = read_grey_image(images_[camera].front().path);
      const CameraIntrinsics intrinsics{first.width, first.height, p[0], p[5], p[2], p[6], {}};
      // P = K [I t]: the point of camera 0 moved by t.
      const Pose camera_from_zero{Eigen::Quaterniond::Identity(), {p[3] / p[0], 0.0, 0.0}};
      const Pose body_from_camera = (camera_from_zero * found->camera_from_lidar * lidar_from_body).inverse();
      if (camera == 0) {
        calibration.camera = intrinsics;
        calibration.body_from_camera = body_from_camera;
      } else {
        calibration.further_cameras.push_back({camera, body_from_camera, intrinsics, calibration.camera_rate_hz});
      }
    }
    return true;
  }

  std::vector<PoseTrack::Stamped> truth(const Calibration& calibration) const {
    const fs::path numbered =
        path_ / ".." / ".." / "poses" / (fs::weakly_canonical(path_).filename().string() + ".txt");
    const fs::path file =
        settings_.truth.empty() ? first_that_exists({path_ / "poses.txt", numbered}) : settings_.truth;
    if (file.empty()) return truth_of_oxts(calibration);
    TextTable table(file);
    if (!table.next() || table.size() != 12) return read_truth_file(file);
    std::vector<Pose> poses;
    do {
      std::vector<double> rows;
      for (std::size_t i = 0; i < table.size(); ++i) rows.push_back(table.number(i));
      poses.push_back(kitti_pose(rows, file.string()));
    } while (table.next());
    return truth_of_camera(poses, file, calibration);
  }

  /// Poses of camera 0, of every scan, or of every scan that the numbering leaves room for.
  std::vector<PoseTrack::Stamped> truth_of_camera(const std::vector<Pose>& poses, const fs::path& file,
                                                  const Calibration& calibration) const {
    std::vector<PoseTrack::Stamped> truth;
    const Pose body_from_camera = camera_of_poses(calibration);
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      const ScanTime& time = scans_[i].time;
      const std::int64_t stamp_ns = compensated() && !fs::exists(path_ / "scans.txt")
                                        ? time.end_ns
                                        : time.start_ns + (time.end_ns - time.start_ns) / 2;
      const bool one_each = poses.size() == scans_.size();
      const Pose& pose = one_each ? poses[i] : at_number(poses, scans_[i].file.number, file);
      truth.push_back({stamp_ns, body_from_camera * pose * body_from_camera.inverse()});
    }
    return truth;
  }

  Pose camera_of_poses(const Calibration& calibration) const {
    if (calibration.has_camera) return calibration.body_from_camera;
    if (const auto found = rectified()) return calibration.body_from_lidar * found->camera_from_lidar.inverse();
    return calibration.body_from_lidar * Pose{body_from_optical_rotation(), Eigen::Vector3d::Zero()};
  }

  std::vector<PoseTrack::Stamped> truth_of_oxts(const Calibration& calibration) const {
    std::vector<PoseTrack::Stamped> truth = oxts_poses_;
    if (truth.empty()) return truth;
    const Pose imu_from_body = dataset_has_imu() ? Pose{} : (calibration.body_from_lidar * lidar_from_imu()).inverse();
    const Eigen::Vector3d start = truth.front().pose.translation;
    for (auto& [stamp_ns, pose] : truth) {
      pose.translation -= start;
      pose = pose * imu_from_body;
    }
    return truth;
  }

  void take_span(Recording& recording) const {
    std::int64_t start_ns = INT64_MAX;
    std::int64_t end_ns = INT64_MIN;
    const auto include = [&](std::int64_t from_ns, std::int64_t to_ns) {
      start_ns = std::min(start_ns, from_ns);
      end_ns = std::max(end_ns, to_ns);
    };
    if (!scans_.empty()) include(scans_.front().time.start_ns, scans_.back().time.end_ns);
    for (const auto& images : images_) {
      if (!images.empty()) include(images.front().stamp_ns, images.back().stamp_ns);
    }
    recording.start_ns = start_ns;
    recording.end_ns = end_ns;
  }

  MessageSource scans(const Calibration& calibration) const {
    return [scans = scans_, folder = path_, azimuth = !compensated(), rings = calibration.lidar_rings,
            next = std::size_t{0}, delivered_ns = INT64_MIN]() mutable -> std::unique_ptr<SensorMessage> {
      if (next == scans.size()) return nullptr;
      const Scan& scan = scans[next++];
      delivered_ns = std::max(delivered_ns, scan.time.end_ns);
      return timed_message([&] { return read_scan(scan, folder, azimuth, rings); }, delivered_ns);
    };
  }

  /// A file of one value for each point, if there is one.
  template <typename Value>
  static std::vector<Value> side_file(const fs::path& folder, const Scan& scan, std::size_t points) {
    const fs::path path = folder / scan.file.path.filename();
    if (!fs::exists(path)) return {};
    const std::string bytes = read_bounded_file(path, kMostSideFileBytes);
    if (bytes.size() != points * sizeof(Value)) {
      throw InputError(path.string() + ": found " + std::to_string(bytes.size()) + " bytes, expected " +
                       std::to_string(sizeof(Value)) + " for each of the scan's " + std::to_string(points) + " points");
    }
    std::vector<Value> values(points);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }

  static LidarScan read_scan(const Scan& scan, const fs::path& folder, bool azimuth, int rings) {
    LidarScan result;
    result.stamp_ns = scan.time.start_ns;
    result.end_ns = scan.time.end_ns;
    result.sweep = scan.time.sweep;
    result.ends_sweep = scan.time.ends_sweep;
    result.points = read_kitti_points(scan.file.path);
    const auto times_s = side_file<float>(folder / "times", scan, result.points.size());
    const auto ring_numbers = side_file<std::uint16_t>(folder / "rings", scan, result.points.size());
    const std::int64_t span_ns = result.end_ns - result.stamp_ns;
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      const double offset_ns = std::round(1e9 * static_cast<double>(times_s[i]));
      // A time that is none, or outside the scan, takes its point along.
      if (!(offset_ns >= 0.0 && offset_ns <= static_cast<double>(span_ns)))
        result.points[i].position.setZero();
      else
        result.points[i].offset_ns = static_cast<std::int32_t>(offset_ns);
    }
    for (std::size_t i = 0; i < ring_numbers.size(); ++i) result.points[i].ring = ring_numbers[i];
    drop_unusable(result.points);
    if (ring_numbers.empty()) assign_rings_by_azimuth(rings, result.points);
    if (times_s.empty() && azimuth) assign_times_by_azimuth(span_ns, result.points);
    sort_by_time(result.points);
    return result;
  }

  fs::path path_;
  DatasetSettings settings_;
  bool is_odometry_ = false;
  std::vector<Scan> scans_;
  std::vector<StampedFile> images_[2];
  std::vector<ImuSample> imu_;
  std::vector<PoseTrack::Stamped> oxts_poses_;
  double mercator_scale_ = 1.0;
};

}  // namespace

Dataset open_kitti(const fs::path& path, const DatasetSettings& settings) { return KittiFolder(path, settings).open(); }

}  // namespace plumbline
