#include "tools/formats/kitti_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>

#include "scenarios/input_error.h"
#include "sim/text_fields.h"
#include "tools/formats/text_table.h"

namespace plumbline {
namespace {

static_assert(std::endian::native == std::endian::little, "fields are copied as they stand in memory");

// 8 million points; the densest head gives a quarter of a million.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{128} << 20;
constexpr std::size_t kMostPoints = 8'000'000;
constexpr std::size_t kMostHeaderBytes = 4096;
constexpr float kFurthest_m = 1e4F;
constexpr std::size_t kBinPointBytes = 16;

// Azimuth falls from 360 to 0 degrees where a ring ends. Motion compensation moves points across the seam and back:
// a rise of nearly a turn is a step back across it.
constexpr double kNewRingFall = 0.5 * std::numbers::pi;
constexpr double kSeamRise = 5.0 / 3.0 * std::numbers::pi;

double azimuth(const LidarPoint& point) {
  return std::atan2(static_cast<double>(point.position.y()), static_cast<double>(point.position.x()));
}

/// From 0 to 2 pi.
double full_azimuth(const LidarPoint& point) {
  const double angle = azimuth(point);
  return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
}

void add_point(const float (&xyzi)[4], std::vector<LidarPoint>& points) {
  LidarPoint point;
  point.position = {xyzi[0], xyzi[1], xyzi[2]};
  point.intensity = std::isfinite(xyzi[3]) ? xyzi[3] : 0.0F;
  points.push_back(point);
}

std::vector<LidarPoint> points_of_bin(const std::filesystem::path& path, const std::string& bytes) {
  if (bytes.size() % kBinPointBytes != 0) {
    throw InputError(path.string() + ": found " + std::to_string(bytes.size()) +
                     " bytes, expected a multiple of 16 (x, y, z, intensity as float32)");
  }
  std::vector<LidarPoint> points;
  points.reserve(bytes.size() / kBinPointBytes);
  for (std::size_t at = 0; at < bytes.size(); at += kBinPointBytes) {
    float xyzi[4];
    std::memcpy(xyzi, bytes.data() + at, kBinPointBytes);
    add_point(xyzi, points);
  }
  return points;
}

/// A PCD file's header, as far as points need it.
struct PcdLayout {
  std::size_t points = 0;
  std::size_t stride = 0;                      // bytes of a point
  std::size_t columns = 0;                     // numbers of a point
  std::size_t offset_bytes[4] = {0, 0, 0, 0};  // of x, y, z, intensity
  std::size_t column_of[4] = {0, 0, 0, 0};
  bool has[4] = {false, false, false, false};
  bool binary = true;
  std::size_t data_at = 0;
};

/// Reads "KEY value value…" lines up to DATA.
class PcdHeader {
 public:
  PcdHeader(const std::filesystem::path& path, const std::string& bytes) : path_(path), bytes_(bytes) {}

  PcdLayout read() {
    while (!data_found_) read_line();
    lay_out();
    return layout_;
  }

 private:
  using Words = std::vector<std::string_view>;

  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_.string() + ": PCD header: " + what); }

  void read_line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string::npos || end > kMostHeaderBytes) fail("no DATA line within its first 4096 bytes");
    line_ = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    const Words words = split_fields(line_);
    if (words.empty() || words[0].front() == '#') return;
    const Words values(words.begin() + 1, words.end());
    if (words[0] == "FIELDS") names_.assign(values.begin(), values.end());
    if (words[0] == "SIZE") sizes_ = counts_in(values);
    if (words[0] == "COUNT") counts_ = counts_in(values);
    if (words[0] == "TYPE") types_.assign(values.begin(), values.end());
    if (words[0] == "POINTS" && values.size() == 1) layout_.points = counts_in(values)[0];
    if (words[0] == "DATA") take_data(values);
  }

  void take_data(const Words& values) {
    if (values.size() != 1 || (values[0] != "binary" && values[0] != "ascii")) {
      fail("DATA is neither binary nor ascii");
    }
    layout_.binary = values[0] == "binary";
    layout_.data_at = at_;
    data_found_ = true;
  }

  std::vector<std::size_t> counts_in(const Words& values) const {
    std::vector<std::size_t> counts;
    for (const std::string_view word : values) {
      const auto value = parse_number(word);
      if (!value || *value < 0.0 || *value > static_cast<double>(kMostPoints)) {
        fail(quoted_field(word) + " is not a number to 8 million");
      }
      counts.push_back(static_cast<std::size_t>(*value));
    }
    return counts;
  }

  void lay_out() {
    static const std::vector<std::string> kWanted{"x", "y", "z", "intensity"};
    if (counts_.empty()) counts_.assign(names_.size(), 1);
    if (names_.empty() || names_.size() > 64 || sizes_.size() != names_.size() || counts_.size() != names_.size() ||
        types_.size() != names_.size()) {
      fail("FIELDS, SIZE, TYPE and COUNT do not agree");
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const auto wanted = std::find(kWanted.begin(), kWanted.end(), names_[i]);
      if (wanted != kWanted.end()) {
        if (sizes_[i] != 4 || types_[i] != "F" || counts_[i] != 1) fail("field " + names_[i] + " is no float32");
        const auto k = static_cast<std::size_t>(wanted - kWanted.begin());
        layout_.offset_bytes[k] = layout_.stride;
        layout_.column_of[k] = layout_.columns;
        layout_.has[k] = true;
      }
      if (sizes_[i] > 8 || counts_[i] > 4096) fail("field " + quoted_field(names_[i]) + " is too large");
      layout_.stride += sizes_[i] * counts_[i];
      layout_.columns += counts_[i];
    }
    if (!layout_.has[0] || !layout_.has[1] || !layout_.has[2]) fail("no fields x, y and z");
  }

  const std::filesystem::path& path_;
  const std::string& bytes_;
  std::size_t at_ = 0;
  std::string line_;
  bool data_found_ = false;
  std::vector<std::string> names_;
  std::vector<std::string> types_;
  std::vector<std::size_t> sizes_;
  std::vector<std::size_t> counts_;
  PcdLayout layout_;
};

std::vector<LidarPoint> points_of_ascii(const std::filesystem::path& path, const std::string& bytes,
                                        const PcdLayout& layout) {
  std::vector<LidarPoint> points;
  std::istringstream text(bytes.substr(layout.data_at));
  std::string line;
  for (std::size_t i = 0; i < layout.points; ++i) {
    const auto words = std::getline(text, line) ? split_fields(line) : std::vector<std::string_view>{};
    if (words.size() != layout.columns)
      throw InputError(path.string() + ": point " + std::to_string(i) + ": cut short");
    float xyzi[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    for (std::size_t k = 0; k < 4; ++k) {
      if (layout.has[k]) xyzi[k] = static_cast<float>(parse_number(words[layout.column_of[k]]).value_or(NAN));
    }
    add_point(xyzi, points);
  }
  return points;
}

std::vector<LidarPoint> points_of_pcd(const std::filesystem::path& path, const std::string& bytes) {
  const PcdLayout layout = PcdHeader(path, bytes).read();
  if (!layout.binary) return points_of_ascii(path, bytes, layout);
  // Writers round the file up to whole memory pages: there may be more than the points, but not less.
  if (bytes.size() - layout.data_at < layout.points * layout.stride) {
    throw InputError(path.string() + ": cut short: " + std::to_string(layout.points) + " points of " +
                     std::to_string(layout.stride) + " bytes do not fit");
  }
  std::vector<LidarPoint> points;
  points.reserve(layout.points);
  for (std::size_t i = 0; i < layout.points; ++i) {
    const char* start = bytes.data() + layout.data_at + i * layout.stride;
    float xyzi[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    for (std::size_t k = 0; k < 4; ++k) {
      if (layout.has[k]) std::memcpy(&xyzi[k], start + layout.offset_bytes[k], sizeof(float));
    }
    add_point(xyzi, points);
  }
  return points;
}

}  // namespace

std::vector<LidarPoint> read_kitti_points(const std::filesystem::path& path) {
  const std::string bytes = read_bounded_file(path, kMostBytes);
  return path.extension() == ".pcd" ? points_of_pcd(path, bytes) : points_of_bin(path, bytes);
}

void drop_unusable(std::vector<LidarPoint>& points) {
  std::erase_if(points, [](const LidarPoint& point) {
    const Eigen::Vector3f& p = point.position;
    return !p.allFinite() || p.cwiseAbs().maxCoeff() > kFurthest_m || p.isZero(0.0F);
  });
}

void assign_rings_by_azimuth(int rings, std::vector<LidarPoint>& points) {
  int below_top = 0;
  double previous = 0.0;
  for (LidarPoint& point : points) {
    double angle = full_azimuth(point);
    if (angle - previous > kSeamRise) angle -= 2.0 * std::numbers::pi;
    if (previous - angle > kNewRingFall) ++below_top;
    previous = angle;
    point.ring = below_top < rings ? static_cast<std::uint16_t>(rings - 1 - below_top) : UINT16_MAX;
  }
  std::erase_if(points, [](const LidarPoint& point) { return point.ring == UINT16_MAX; });
}

void assign_times_by_azimuth(std::int64_t duration_ns, std::vector<LidarPoint>& points) {
  const auto last_ns = static_cast<double>(std::max<std::int64_t>(duration_ns - 1, 0));
  for (LidarPoint& point : points) {
    const double share = 0.5 - azimuth(point) / (2.0 * std::numbers::pi);
    point.offset_ns = static_cast<std::int32_t>(std::clamp(share * static_cast<double>(duration_ns), 0.0, last_ns));
  }
}

void sort_by_time(std::vector<LidarPoint>& points) {
  std::stable_sort(points.begin(), points.end(), [](const LidarPoint& a, const LidarPoint& b) {
    return a.offset_ns != b.offset_ns ? a.offset_ns < b.offset_ns : a.ring < b.ring;
  });
}

void sort_as_kitti(std::vector<LidarPoint>& points) {
  std::stable_sort(points.begin(), points.end(), [](const LidarPoint& a, const LidarPoint& b) {
    return a.ring != b.ring ? a.ring > b.ring : full_azimuth(a) < full_azimuth(b);
  });
}

std::string kitti_bin(const std::vector<LidarPoint>& points) {
  std::string bytes(points.size() * kBinPointBytes, '\0');
  std::size_t at = 0;
  for (const LidarPoint& point : points) {
    const float xyzi[4] = {point.position.x(), point.position.y(), point.position.z(), point.intensity};
    std::memcpy(bytes.data() + at, xyzi, kBinPointBytes);
    at += kBinPointBytes;
  }
  return bytes;
}

}  // namespace plumbline
