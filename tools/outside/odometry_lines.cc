#include "tools/outside/odometry_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

constexpr double kGreatest = 1e9;  // position [m] or velocity [m/s]: beyond it there is no sense
constexpr std::size_t kMostHealth = 1000;
constexpr std::size_t kMostPoints = 5'000'000;
constexpr std::size_t kMostReasons = 100;
constexpr const char* kGreeting = "plumbline-odometry";
constexpr std::array kModuleWords{Module::kImu, Module::kVision, Module::kLidar};
constexpr std::array kModes{ModuleMode::kSolved, ModuleMode::kPartial, ModuleMode::kBypassed};

void append(std::string& line, double value) { append_exact(line += ' ', value); }
void append(std::string& line, std::int64_t value) { line += ' ' + std::to_string(value); }
void append(std::string& line, std::string_view word) { (line += ' ') += word; }
template <typename Derived>
void append(std::string& line, const Eigen::MatrixBase<Derived>& matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) append(line, double{matrix(row, column)});
  }
}

template <typename... Fields>
std::string line_of(std::string word, const Fields&... fields) {
  (append(word, fields), ...);
  return word + '\n';
}

/// Takes a line apart, strictly.
class Words {
 public:
  explicit Words(const std::string& line) : line_(line), rest_(line) {}

  std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
    const std::string_view found = rest_.substr(0, rest_.find_first_of(" \t"));
    rest_.remove_prefix(found.size());
    return found;
  }
  double number() { return parsed<double>("a finite number"); }
  std::int64_t whole() { return parsed<std::int64_t>("a whole number"); }
  std::int64_t count() {
    const std::int64_t value = whole();
    if (value < 0) fail("a count is not negative");
    return value;
  }
  template <typename Derived>
  void read(Eigen::MatrixBase<Derived>& matrix) {
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      for (Eigen::Index column = 0; column < matrix.cols(); ++column) {
        matrix(row, column) = static_cast<typename Derived::Scalar>(number());
      }
    }
  }
  template <typename Choices>
  auto one_of(const Choices& choices) {
    const std::string_view found = word();
    for (const auto choice : choices) {
      if (to_string(choice) == found) return choice;
    }
    fail("found the word '" + std::string(found) + "'");
  }
  std::string rest() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
    return std::string(std::exchange(rest_, {}));
  }
  bool at_end() const { return rest_.find_first_not_of(" \t") == std::string_view::npos; }
  void finish() const {
    if (!at_end()) fail("more fields than there should be");
  }
  [[noreturn]] void fail(const std::string& what) const {
    constexpr std::size_t kShown = 120;
    std::string shown = line_.substr(0, kShown);
    std::replace_if(
        shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    throw std::invalid_argument("wrote the line '" + shown + (line_.size() > kShown ? "...'" : "'") + ": " + what);
  }

 private:
  template <typename T>
  T parsed(const char* expected) {
    const std::string_view text = word();
    T value{};
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole_word = error == std::errc() && stop == text.data() + text.size();
    if (!is_whole_word || !std::isfinite(static_cast<double>(value))) {
      fail(text.empty() ? std::string("a field is missing")
                        : "found '" + std::string(text.substr(0, 40)) + "', expected " + expected);
    }
    return value;
  }

  const std::string& line_;
  std::string_view rest_;
};

ModuleHealth health_of(Words& words) {
  ModuleHealth health;
  health.stamp_ns = words.whole();
  health.module = words.one_of(kModuleWords);
  health.mode = words.one_of(kModes);
  health.well_conditioned = static_cast<int>(words.count());
  if (health.well_conditioned > 6) words.fail("at most 6 directions are well conditioned");
  health.rows = static_cast<int>(std::min<std::int64_t>(words.count(), 1'000'000'000));
  health.inliers = static_cast<int>(std::min<std::int64_t>(words.count(), 1'000'000'000));
  health.processing_s = words.number();
  words.read(health.eigenvalues);
  words.read(health.eigenvectors);
  words.read(health.correction);
  return health;
}

void read_pose(Words& words, Odometry& odometry) {
  odometry.stamp_ns = words.whole();
  Pose& pose = odometry.world_from_body;
  words.read(pose.translation);
  words.read(pose.rotation.coeffs());
  if (pose.translation.cwiseAbs().maxCoeff() > kGreatest) words.fail("a position is within 1e9 m");
  if (!(std::abs(pose.rotation.norm() - 1.0) < 1e-3)) words.fail("a quaternion has unit length");
  if (std::abs(pose.rotation.norm() - 1.0) > 1e-12) pose.rotation.normalize();
}

std::uint8_t colour_of(Words& words) {
  const std::int64_t value = words.count();
  if (value > 255) words.fail("a colour is from 0 to 255");
  return static_cast<std::uint8_t>(value);
}

}  // namespace

std::string greeting_line(bool acknowledge) {
  return std::string(kGreeting) + ' ' + std::to_string(kOdometryLinesVersion) + (acknowledge ? " acknowledge\n" : "\n");
}

std::optional<bool> read_greeting(const std::string& line) {
  for (const bool acknowledge : {false, true}) {
    if (line + '\n' == greeting_line(acknowledge)) return acknowledge;
  }
  return std::nullopt;
}

std::string odometry_lines(const Odometry& o) {
  std::string text;
  for (const ModuleHealth& h : o.health) {
    text += line_of("health", h.stamp_ns, to_string(h.module), to_string(h.mode), std::int64_t{h.well_conditioned},
                    std::int64_t{h.rows}, std::int64_t{h.inliers}, h.processing_s, h.eigenvalues, h.eigenvectors,
                    h.correction);
  }
  text += line_of("velocity", o.velocity_in_world) + line_of("gyro_bias", o.gyro_bias) +
          line_of("accel_bias", o.accel_bias) + line_of("covariance", o.covariance) +
          line_of("increment_covariance", o.increment_covariance);
  if (o.lost) text += line_of("lost");
  return text + line_of("pose", o.stamp_ns, o.world_from_body.translation, o.world_from_body.rotation.coeffs());
}

std::string counts_lines(Module module, const MessageCounts& counts) {
  std::string text = line_of("used", to_string(module), counts.used);
  for (const auto& [reason, count] : counts.dropped) text += line_of("dropped", to_string(module), count, reason);
  return text;
}

std::string point_line(const MapPoint& point) {
  std::string line = "point";
  append(line, point.position);
  append(line, double{point.intensity});
  if (point.coloured) {
    for (const std::uint8_t value : point.colour) append(line, std::int64_t{value});
  }
  return line + '\n';
}

bool OdometryLines::add(const std::string& line) {
  Words words(line);
  const std::string_view kind = words.word();
  if (kind == "velocity") {
    words.read(odometry_.velocity_in_world);
    if (odometry_.velocity_in_world.cwiseAbs().maxCoeff() > kGreatest) words.fail("a velocity is within 1e9 m/s");
  } else if (kind == "gyro_bias") {
    words.read(odometry_.gyro_bias);
  } else if (kind == "accel_bias") {
    words.read(odometry_.accel_bias);
  } else if (kind == "covariance") {
    words.read(odometry_.covariance);
  } else if (kind == "increment_covariance") {
    words.read(odometry_.increment_covariance);
  } else if (kind == "lost") {
    odometry_.lost = true;
  } else if (kind == "health") {
    if (odometry_.health.size() == kMostHealth) words.fail("more than 1000 solves before one pose");
    odometry_.health.push_back(health_of(words));
  } else if (kind == "pose") {
    read_pose(words, odometry_);
  } else {
    words.fail("expected a pose, or none");
  }
  words.finish();
  return kind == "pose";
}

Odometry OdometryLines::take() { return std::exchange(odometry_, {}); }

void ClosingLines::add(const std::string& line) {
  Words words(line);
  const std::string_view kind = words.word();
  if (kind == "used") {
    const Module module = words.one_of(kModuleWords);
    counts[module].used = words.count();
  } else if (kind == "dropped") {
    auto& dropped = counts[words.one_of(kModuleWords)].dropped;
    const std::int64_t count = words.count();
    const std::string reason = words.rest();
    if (reason.empty()) words.fail("a reason is missing");
    if (dropped.size() == kMostReasons) words.fail("more than 100 reasons");
    dropped[reason] = count;
  } else if (kind == "point") {
    if (map.size() == kMostPoints) words.fail("more than 5000000 points");
    MapPoint& point = map.emplace_back();
    words.read(point.position);
    point.intensity = static_cast<float>(words.number());
    if (!point.position.allFinite() || !std::isfinite(point.intensity)) words.fail("a number beyond all sense");
    point.coloured = !words.at_end();
    if (point.coloured) {
      for (std::uint8_t& value : point.colour) value = colour_of(words);
    }
  } else {
    words.fail("expected used, dropped or point after the last message");
  }
  words.finish();
}

}  // namespace plumbline
