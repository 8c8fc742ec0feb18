#include "tools/verify/lidar_effects_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include "sensors/lidar_noise.h"
#include "tools/verify/lidar_stand.h"

namespace plumbline {
namespace {

constexpr double kPi = std::numbers::pi;

LidarEffects only(bool LidarEffects::*effect) {
  LidarEffects effects = LidarEffects::none();
  effects.*effect = true;
  return effects;
}

/// The target's plane, below.
LidarStand place_with(const LidarTarget& floor) {
  const double height_m = floor.range_m * std::cos(floor.incidence_deg * kPi / 180.0);
  return LidarStand("<geom type=\"plane\" size=\"0 0 1\" pos=\"0 0 " + std::to_string(-height_m) + "\"/>",
                    floor.reflectivity);
}

/// A device with one of its beams, which fires 20,000 times in 0.1 s.
LidarModel one_beam(LidarModel model, const LidarTarget& floor) {
  model.beams = {{.elevation_deg = floor.incidence_deg - 90.0}};
  model.head = SpinningHead{5e-6};
  model.encoder_resolution_deg = 0.0;
  model.max_range_m = 200.0;
  return model;
}

/// The chance of a chi^2 as large, by Wilson and Hilferty's cube root.
double chance_of_chi_squared(double chi_squared, double degrees) {
  const double spread = 2.0 / (9.0 * degrees);
  return normal_cdf((1.0 - spread - std::cbrt(chi_squared / degrees)) / std::sqrt(spread));
}

struct Cell {
  double expected = 0.0;
  double observed = 0.0;
};

/// Neighbouring cells are joined until at least 20 are expected in each.
double chance_of(const std::vector<Cell>& cells, bool total_is_fixed) {
  double chi_squared = 0.0;
  int count = 0;
  Cell joined;
  std::vector<Cell> large;
  for (const Cell& cell : cells) {
    joined.expected += cell.expected;
    joined.observed += cell.observed;
    if (joined.expected < 20.0) continue;
    large.push_back(joined);
    joined = {};
  }
  large.back().expected += joined.expected;
  large.back().observed += joined.observed;
  for (const Cell& cell : large) {
    chi_squared += std::pow(cell.observed - cell.expected, 2) / cell.expected;
    ++count;
  }
  return chance_of_chi_squared(chi_squared, count - (total_is_fixed ? 1 : 0));
}

/// Ranges in steps of the resolution, against a normal distribution rounded to it.
double chance_of_range_noise(const LidarTarget& floor) {
  LidarModel model = one_beam(vlp16(), floor);
  LidarEffects effects = only(&LidarEffects::range_noise);
  effects.quantisation = true;
  const double sigma_m =
      expected_range_sigma_m(model, floor.range_m, floor.reflectivity, floor.incidence_deg * kPi / 180);
  const LidarScan scan = place_with(floor).scan(Lidar(model, Pose{}, 11, effects));
  const double step_m = model.range_resolution_m;
  std::map<std::int64_t, double> count;
  for (const LidarPoint& point : scan.points) ++count[std::llround(point.position.cast<double>().norm() / step_m)];
  std::vector<Cell> cells;
  const auto middle = std::llround(floor.range_m / step_m);
  const auto reach = static_cast<std::int64_t>(8.0 * sigma_m / step_m) + 2;
  const auto below = [&](double steps) { return normal_cdf((steps * step_m - floor.range_m) / sigma_m); };
  for (std::int64_t k = middle - reach; k <= middle + reach; ++k) {
    const double share = below(static_cast<double>(k) + 0.5) - below(static_cast<double>(k) - 0.5);
    cells.push_back({share * static_cast<double>(scan.points.size()), count[k]});
  }
  return chance_of(cells, true);
}

/// Returns among the firings, around where the device begins to lose them.
double chance_of_drop_out() {
  double chi_squared = 0.0;
  int count = 0;
  for (const double incidence_deg : {0.0, 40.0, 75.0}) {
    for (const double share_of_limit : {0.85, 0.95, 1.0, 1.05, 1.15}) {
      LidarTarget floor{0.0, incidence_deg, 0.3F};
      LidarModel model = one_beam(vlp16(), floor);
      model.beams[0].elevation_deg = std::max(-89.9, model.beams[0].elevation_deg);
      const double incidence = (model.beams[0].elevation_deg + 90.0) * kPi / 180.0;
      floor.incidence_deg = model.beams[0].elevation_deg + 90.0;
      floor.range_m = share_of_limit * model.range_at_10_percent_m * std::sqrt(3.0 * std::cos(incidence));
      const LidarScan scan = place_with(floor).scan(Lidar(model, Pose{}, 5, only(&LidarEffects::drop_out)), count);
      const double firings = 20000.0;
      const double share = expected_return_share(model, floor.range_m, floor.reflectivity, incidence);
      const double variance = firings * share * (1.0 - share);
      chi_squared += std::pow(static_cast<double>(scan.points.size()) - firings * share, 2) / variance;
      ++count;
    }
  }
  return chance_of_chi_squared(chi_squared, count);
}

// Slats 8 m away before a wall 8.3 m away, all around: at their edges the two merge into ranges between them. How far
// in between follows from the Gaussian's share on the slat, so a class of it belongs to a band of widths at the edge.
double chance_of_mixed_pixels() {
  constexpr double kNear_m = 8.0;
  constexpr double kFar_m = 8.3;
  constexpr int kSlats = 20;
  constexpr int kScans = 10;
  std::ostringstream geoms;
  geoms << "<geom type=\"cylinder\" size=\"" << kFar_m << " 20\"/>";
  for (int i = 0; i < kSlats; ++i) {
    const double azimuth = 2.0 * kPi * i / kSlats;
    geoms << "<geom type=\"box\" size=\"0.001 0.15 5\" pos=\"" << (kNear_m + 0.001) * std::cos(azimuth) << ' '
          << (kNear_m + 0.001) * std::sin(azimuth) << " 0\" euler=\"0 0 " << azimuth * 180.0 / kPi << "\"/>";
  }
  const LidarStand place(geoms.str());
  LidarModel model = vlp16();
  for (LidarBeam& beam : model.beams) beam.vertical_offset_m = 0.0;
  const Lidar lidar(model, Pose{}, 3, only(&LidarEffects::mixed_pixels));
  // In shares of the energy on the slat, halfway between what the sub-rays can give.
  std::vector<double> limits;
  for (const double rays : {1.5, 3.5, 5.5, 6.5, 8.5, 10.5}) limits.push_back(rays / LidarFootprint::kRays);
  std::vector<Cell> cells(limits.size() - 1);
  // Edges are 0.15 m from the slat's middle, so a little farther away.
  const double edge_m = std::hypot(kNear_m, 0.15);
  for (int scan = 0; scan < kScans; ++scan) {
    for (const LidarPoint& point : place.scan(lidar, scan).points) {
      const double range_m = std::hypot(point.position.x(), point.position.y());
      // The range is the mean weighted by signals, which go with 1 / range^2.
      const double slat = (kFar_m - range_m) * edge_m * edge_m;
      const double wall = (range_m - edge_m) * kFar_m * kFar_m;
      const double share = slat / (slat + wall);
      for (std::size_t c = 0; c < cells.size(); ++c)
        if (share >= limits[c] && share < limits[c + 1]) ++cells[c].observed;
    }
  }
  const double step_m = edge_m * 2.0 * kPi * 55.296e-6 * model.rate_hz;  // between a beam's firings
  for (const LidarBeam& beam : model.beams) {
    const double range_m = edge_m / std::cos(beam.elevation_deg * kPi / 180.0);
    const double half_width_m = 0.5 * (model.exit_width_m + model.divergence_horizontal_rad * range_m);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const double band_m = 0.5 * half_width_m * (gaussian_quantile(limits[c + 1]) - gaussian_quantile(limits[c]));
      cells[c].expected += 2.0 * kSlats * kScans * band_m / step_m;
    }
  }
  return chance_of(cells, false);
}

}  // namespace

TargetReturns returns_of(const LidarModel& device, const LidarTarget& target) {
  LidarTarget floor = target;
  floor.incidence_deg = std::max(floor.incidence_deg, 0.1);  // straight down a beam has no azimuth
  const LidarModel model = one_beam(device, floor);
  LidarEffects effects = only(&LidarEffects::range_noise);
  effects.drop_out = true;
  // Targets differ: one seed for all would draw the same noise for each.
  const std::string name = device.name + ' ' + std::to_string(target.range_m) + ' ' +
                           std::to_string(target.incidence_deg) + ' ' + std::to_string(target.reflectivity);
  const Lidar lidar(model, Pose{}, derive_seed(7, name), effects);
  const LidarScan scan = place_with(floor).scan(lidar);
  const double incidence = floor.incidence_deg * kPi / 180.0;
  TargetReturns returns;
  returns.firings = std::round(1e-9 * static_cast<double>(lidar.period_ns()) / 5e-6);
  double square_sum = 0.0;
  for (const LidarPoint& point : scan.points) {
    square_sum += std::pow(point.position.cast<double>().norm() - floor.range_m, 2);
  }
  const auto count = static_cast<double>(scan.points.size());
  returns.sigma_m = std::sqrt(square_sum / count);
  returns.expected_sigma_m = expected_range_sigma_m(model, floor.range_m, floor.reflectivity, incidence);
  returns.share = count / returns.firings;
  returns.expected_share = expected_return_share(model, floor.range_m, floor.reflectivity, incidence);
  return returns;
}

std::map<std::string, double> lidar_effect_chances() {
  return {{"noise near and square", chance_of_range_noise({3.0, 10.0, 0.5F})},
          {"noise far", chance_of_range_noise({40.0, 10.0, 0.5F})},
          {"noise oblique", chance_of_range_noise({10.0, 75.0, 0.5F})},
          {"noise dark", chance_of_range_noise({15.0, 10.0, 0.05F})},
          {"drop-out", chance_of_drop_out()},
          {"mixed pixels", chance_of_mixed_pixels()}};
}

}  // namespace plumbline
