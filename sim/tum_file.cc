#include "sim/tum_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace plumbline {
namespace {

// Ten hours at 200 Hz are 7 million lines of some 100 bytes.
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 30;
constexpr std::size_t kMaxLineBytes = 1024;
constexpr double kMaxPosition = 1e8;                 // [m], twice around the earth
constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // fits int64 nanoseconds
constexpr double kQuaternionTolerance = 0.01;

/// Where in a file something was found, for messages.
struct Place {
  const std::filesystem::path& path;
  std::size_t line = 0;

  [[noreturn]] void reject(const std::string& what) const {
    throw std::invalid_argument(path.string() + ":" + std::to_string(line) + ": " + what);
  }
};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t at = 0;
  while (at < line.size()) {
    while (at < line.size() && is_space(line[at])) ++at;
    const std::size_t start = at;
    while (at < line.size() && !is_space(line[at])) ++at;
    if (at > start) words.push_back(line.substr(start, at - start));
  }
  return words;
}

/// A word as it may appear in a message: short, printable.
std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 40)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (word.size() > 40 ? "…'" : "'");
}

std::optional<double> parse_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// "-12.345" to nanoseconds without rounding; digits past the ninth decimal round to nearest.
std::optional<std::int64_t> parse_plain_stamp(std::string_view word) {
  const bool negative = !word.empty() && word.front() == '-';
  if (negative) word.remove_prefix(1);
  const std::size_t point = std::min(word.find('.'), word.size());
  const std::string_view whole = word.substr(0, point);
  const std::string_view fraction = point < word.size() ? word.substr(point + 1) : std::string_view{};
  if (whole.empty() && fraction.empty()) return std::nullopt;

  std::int64_t stamp_ns = 0;
  for (const char c : whole) {
    if (c < '0' || c > '9' || stamp_ns > kMaxSeconds) return std::nullopt;
    stamp_ns = 10 * stamp_ns + (c - '0');
  }
  if (stamp_ns > kMaxSeconds) return std::nullopt;
  for (std::size_t i = 0; i < 9; ++i) {
    const char c = i < fraction.size() ? fraction[i] : '0';
    if (c < '0' || c > '9') return std::nullopt;
    stamp_ns = 10 * stamp_ns + (c - '0');
  }
  for (std::size_t i = 9; i < fraction.size(); ++i) {
    if (fraction[i] < '0' || fraction[i] > '9') return std::nullopt;
  }
  if (fraction.size() > 9 && fraction[9] >= '5') ++stamp_ns;
  return negative ? -stamp_ns : stamp_ns;
}

/// Plain decimals exactly; exponent notation ("1.3e9"), which no writer means to be exact, through a double.
std::optional<std::int64_t> parse_stamp(std::string_view word) {
  if (const auto exact = parse_plain_stamp(word)) return exact;
  const auto seconds = parse_number(word);
  if (!seconds || std::abs(*seconds) > static_cast<double>(kMaxSeconds)) return std::nullopt;
  return static_cast<std::int64_t>(std::llround(*seconds * 1e9));
}

PoseTrack::Stamped parse_pose(const std::vector<std::string_view>& words, const Place& place) {
  if (words.size() != 8) {
    place.reject("found " + std::to_string(words.size()) +
                 " values; a pose is 'stamp x y z qx qy qz qw', eight numbers");
  }
  PoseTrack::Stamped stamped;
  const auto stamp_ns = parse_stamp(words[0]);
  if (!stamp_ns) place.reject("stamp " + quoted(words[0]) + " is not a time in seconds below 9e9");
  stamped.stamp_ns = *stamp_ns;

  std::array<double, 7> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = parse_number(words[i + 1]);
    if (!value) place.reject(quoted(words[i + 1]) + " is not a finite number");
    values[i] = *value;
    if (i < 3 && std::abs(values[i]) > kMaxPosition) {
      place.reject("position " + quoted(words[i + 1]) + " is out of range; allowed are up to 1e8 m");
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
    const auto words = split(line);
    if (words.empty() || words.front().front() == '#') continue;
    const auto stamped = parse_pose(words, place);
    if (!poses.empty() && stamped.stamp_ns <= poses.back().stamp_ns) {
      place.reject("stamp " + quoted(words[0]) + " is not later than the one before; stamps must increase");
    }
    poses.push_back(stamped);
  }
  if (poses.empty()) throw std::invalid_argument(path.string() + ": holds no pose");
  return poses;
}

}  // namespace plumbline
