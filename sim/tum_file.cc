#include "sim/tum_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

#include "sim/text_fields.h"

namespace plumbline {
namespace {

// Ten hours at 200 Hz are 7 million lines of some 100 bytes.
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 30;
constexpr std::size_t kMaxLineBytes = 1024;
constexpr double kMaxPosition = 1e8;  // [m], twice around the earth
constexpr double kQuaternionTolerance = 0.01;

/// Where in a file something was found, for messages.
struct Place {
  const std::filesystem::path& path;
  std::size_t line = 0;

  [[noreturn]] void reject(const std::string& what) const {
    throw std::invalid_argument(path.string() + ":" + std::to_string(line) + ": " + what);
  }
};

PoseTrack::Stamped parse_pose(const std::vector<std::string_view>& words, const Place& place) {
  if (words.size() != 8) {
    place.reject("found " + std::to_string(words.size()) +
                 " values; a pose is 'stamp x y z qx qy qz qw', eight numbers");
  }
  PoseTrack::Stamped stamped;
  const auto stamp_ns = parse_stamp(words[0]);
  if (!stamp_ns) place.reject("stamp " + quoted_field(words[0]) + " is not a time in seconds below 9e9");
  stamped.stamp_ns = *stamp_ns;

  std::array<double, 7> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = parse_number(words[i + 1]);
    if (!value) place.reject(quoted_field(words[i + 1]) + " is not a finite number");
    values[i] = *value;
    if (i < 3 && std::abs(values[i]) > kMaxPosition) {
      place.reject("position " + quoted_field(words[i + 1]) + " is out of range; allowed are up to 1e8 m");
    }
  }
  stamped.pose.translation = {values[0], values[1], values[2]};
  const Eigen::Quaterniond rotation(values[6], values[3], values[4], values[5]);
  if (std::abs(rotation.norm() - 1.0) > kQuaternionTolerance) {
    place.reject("quaternion has norm " + std::to_string(rotation.norm()) + "; allowed is 1 ± 0.01");
  }
  stamped.pose.rotation = rotation.normalized();
  return stamped;
}

void check_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw std::invalid_argument(path.string() + ": no such file");
  if (!std::filesystem::is_regular_file(path, error))
    throw std::invalid_argument(path.string() + ": not a regular file");
  if (const auto size = std::filesystem::file_size(path, error); error || size > kMaxFileBytes) {
    throw std::invalid_argument(path.string() + ": the file is larger than 1 GiB, the most that is read");
  }
}

}  // namespace

std::vector<PoseTrack::Stamped> read_tum_file(const std::filesystem::path& path) {
  check_file(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::invalid_argument(path.string() + ": cannot be read");

  std::vector<PoseTrack::Stamped> poses;
  Place place{path};
  for (std::string line; std::getline(stream, line);) {
    ++place.line;
    if (line.size() > kMaxLineBytes) place.reject("the line is longer than 1024 bytes");
    const auto words = split_fields(line);
    if (words.empty() || words.front().front() == '#') continue;
    const auto stamped = parse_pose(words, place);
    if (!poses.empty() && stamped.stamp_ns <= poses.back().stamp_ns) {
      place.reject("stamp " + quoted_field(words[0]) + " is not later than the one before; stamps must increase");
    }
    poses.push_back(stamped);
  }
  if (poses.empty()) throw std::invalid_argument(path.string() + ": holds no pose");
  return poses;
}

}  // namespace plumbline
