#include "sim/scenes/ribbon.h"

#include <algorithm>
#include <cmath>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr double kLeastWidth_m = 1e-3;

double lattice(std::uint64_t seed, std::int64_t x, std::int64_t y) {
  const std::uint64_t place = mix_bits(static_cast<std::uint64_t>(x) ^ mix_bits(static_cast<std::uint64_t>(y)));
  return static_cast<double>(mix_bits(seed ^ place) >> 11) * 0x1.0p-52 - 1.0;
}

double ease(double t) { return t * t * (3.0 - 2.0 * t); }

std::vector<Eigen::Vector3d> points_of(const RoadLine& line, const Section& section, double s) {
  std::vector<Eigen::Vector3d> points;
  for (const Station& station : section.stations) points.push_back(line.place(s, station.n, station.up));
  return points;
}

}  // namespace

double smooth_noise(std::uint64_t seed, double x, double y) {
  const double cell_x = std::floor(x);
  const double cell_y = std::floor(y);
  const auto i = static_cast<std::int64_t>(cell_x);
  const auto j = static_cast<std::int64_t>(cell_y);
  const double u = ease(x - cell_x);
  const double v = ease(y - cell_y);
  const double low = lattice(seed, i, j) + u * (lattice(seed, i + 1, j) - lattice(seed, i, j));
  const double high = lattice(seed, i, j + 1) + u * (lattice(seed, i + 1, j + 1) - lattice(seed, i, j + 1));
  return low + v * (high - low);
}

double Section::up_at(double n) const {
  if (n <= stations.front().n) return stations.front().up;
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const Station& right = stations[i - 1];
    const Station& left = stations[i];
    if (n > left.n) continue;
    const double width = left.n - right.n;
    return width < kLeastWidth_m ? left.up : right.up + (left.up - right.up) * (n - right.n) / width;
  }
  return stations.back().up;
}

void add_ribbon(Scenery& scenery, const RoadLine& line, const SectionAt& section_at, double from_s, double to_s,
                double step_m) {
  const int rows = std::max(1, static_cast<int>(std::ceil((to_s - from_s) / step_m)));
  Section before = section_at(from_s);
  std::vector<Eigen::Vector3d> near = points_of(line, before, from_s);
  for (int row = 1; row <= rows; ++row) {
    const double s = std::min(to_s, from_s + row * step_m);
    Section after = section_at(s);
    std::vector<Eigen::Vector3d> far = points_of(line, after, s);
    for (std::size_t i = 0; i + 1 < near.size(); ++i) {
      const bool flat = (near[i + 1] - near[i]).norm() < kLeastWidth_m && (far[i + 1] - far[i]).norm() < kLeastWidth_m;
      if (flat || before.materials[i].empty()) continue;
      scenery.quad(before.materials[i], near[i], far[i], far[i + 1], near[i + 1]);
    }
    before = std::move(after);
    near = std::move(far);
  }
}

}  // namespace plumbline
