#include "tools/verify/lidar_section.h"

#include <algorithm>
#include <cmath>

#include "scenarios/catalogue.h"
#include "tools/formats/number_text.h"
#include "tools/report/svg_chart.h"
#include "tools/verify/deskew_check.h"
#include "tools/verify/lidar_effects_check.h"
#include "tools/verify/lidar_firing_check.h"
#include "tools/verify/lidar_spread_check.h"

namespace plumbline {
namespace {

void add_firing_rows(std::vector<VerifyRow>& rows) {
  for (const FiringCheck& check : check_lidar_firing()) {
    const std::string device = check.device + " at " + fixed_text(check.rate_hz, 0) + " Hz: ";
    std::string angle;
    append_general(angle, check.worst_angle_deg, 2);
    rows.push_back({device + "firing times and beam angles against the data sheet", "1 ns, 1e-4°",
                    fixed_text(check.worst_time_ns, 2) + " ns, " + angle + "°",
                    check.worst_time_ns <= 1.0 && check.worst_angle_deg <= 1e-4 && check.misplaced == 0});
    rows.push_back({device + "points per second", std::to_string(check.expected_points), std::to_string(check.points),
                    check.points == check.expected_points});
  }
}

void add_chance_rows(std::vector<VerifyRow>& rows) {
  const auto chances = lidar_effect_chances();
  const double least = 0.01 / static_cast<double>(chances.size());
  for (const auto& [what, chance] : chances) {
    rows.push_back({"vlp16: " + what + ", chance of a χ² as large, of " + std::to_string(chances.size()) + " together",
                    "≥ " + fixed_text(least, 4), fixed_text(chance, 3), chance >= least});
  }
}

void add_deskew_rows(std::vector<VerifyRow>& rows) {
  for (const std::string& name : catalogue_names("lidar")) {
    const DeskewCheck check = check_deskew(catalogue_lidar(name));
    rows.push_back({name + ": noise-free scan of a 36 m hall at 370 °/s: worst point de-skewed; 95th percentile raw",
                    "≤ 1 mm; > 0.3 m",
                    fixed_text(1e3 * check.worst_m, 4) + " mm; " + fixed_text(check.raw_percentile_m, 2) + " m",
                    check.worst_m <= 1e-3 && check.raw_percentile_m > 0.3});
  }
}

void add_spread_rows(std::vector<VerifyRow>& rows) {
  for (const SpreadCheck& check : check_lidar_spread()) {
    const double factor = check.sigma_m / check.real_sigma_m;
    rows.push_back({check.device + ": median spread on flat patches, " + fixed_text(check.least_range_m, 0) + " to " +
                        fixed_text(check.greatest_range_m, 0) + " m",
                    "a real one's " + fixed_text(1e3 * check.real_sigma_m, 1) + " mm, within a factor of 1.5",
                    fixed_text(1e3 * check.sigma_m, 1) + " mm of " + std::to_string(check.patches) + " patches",
                    factor < 1.5 && factor > 1.0 / 1.5});
  }
}

struct Sweep {
  double incidence_deg;
  float reflectivity;
  std::string label;
  std::string css_class;
};

const std::vector<Sweep>& sweeps() {
  static const std::vector<Sweep> all{{0.0, 0.5F, "50 %, square", "c0"},
                                      {70.0, 0.5F, "50 %, 70°", "c1"},
                                      {0.0, 0.1F, "10 %, square", "c2"},
                                      {70.0, 0.1F, "10 %, 70°", "c3"}};
  return all;
}

LineChart chart_over_range(const std::string& caption, const std::string& unit, double farthest_m) {
  LineChart chart;
  chart.caption = caption;
  chart.unit = unit;
  chart.x = {0.0, farthest_m};
  chart.x_label = "range [m]";
  return chart;
}

/// Noise and returns over range, incidence and reflectivity.
void add_target_check(const std::string& name, VerifySection& section) {
  constexpr int kPlaces = 14;
  // Standard errors of 20,000 firings, or the half that return: 0.7 % of a deviation, 0.35 % of a share.
  constexpr double kMaxSigmaError = 0.035;
  constexpr double kMaxShareError = 0.0175;
  const LidarModel device = catalogue_lidar(name);
  const double farthest_m = 2.2 * device.range_at_10_percent_m;
  LineChart noise = chart_over_range(name + ", range noise", "mm", farthest_m);
  LineChart returns = chart_over_range(name + ", share of firings that return", "%", farthest_m);
  double sigma_error = 0.0;
  double share_error = 0.0;
  for (const Sweep& sweep : sweeps()) {
    ChartSeries sigma{sweep.label, sweep.css_class, {}, {}};
    ChartSeries share = sigma;
    ChartSeries expected_sigma{&sweep == &sweeps().front() ? "model" : "", "truth", {}, {}};
    ChartSeries expected_share = expected_sigma;
    for (int i = 1; i <= kPlaces; ++i) {
      const double range_m = farthest_m * i / kPlaces;
      const TargetReturns found = returns_of(device, {range_m, sweep.incidence_deg, sweep.reflectivity});
      const bool half_return = found.expected_share > 0.5;
      for (ChartSeries* series : {&sigma, &share, &expected_sigma, &expected_share}) series->x.push_back(range_m);
      sigma.y.push_back(half_return ? 1e3 * found.sigma_m : std::nan(""));
      expected_sigma.y.push_back(half_return ? 1e3 * found.expected_sigma_m : std::nan(""));
      share.y.push_back(100.0 * found.share);
      expected_share.y.push_back(100.0 * found.expected_share);
      if (half_return) sigma_error = std::max(sigma_error, std::abs(found.sigma_m / found.expected_sigma_m - 1.0));
      share_error = std::max(share_error, std::abs(found.share - found.expected_share));
    }
    noise.series.insert(noise.series.end(), {expected_sigma, sigma});
    returns.series.insert(returns.series.end(), {expected_share, share});
  }
  section.rows.push_back({name + ": range noise over range, incidence and reflectivity, worst where half return",
                          "within 3.5 %", fixed_text(100.0 * sigma_error, 2) + " %", sigma_error <= kMaxSigmaError});
  section.rows.push_back({name + ": share of firings that return, worst of the same targets", "within 1.75 points",
                          fixed_text(100.0 * share_error, 2) + " points", share_error <= kMaxShareError});
  section.charts += "<div class=\"pair\">" + line_chart(noise) + line_chart(returns) + "</div>";
}

}  // namespace

VerifySection lidar_section() {
  VerifySection section;
  section.title = "Lidars";
  section.note =
      "When and where to beams fire, against the data sheets; errors of the returns, against the configured model; "
      "scans of a hall while the lidar is spun by hand; and spreads on flat patches, against real devices.";
  add_firing_rows(section.rows);
  add_chance_rows(section.rows);
  for (const char* name : {"vlp16", "hdl32e", "hdl64e", "os1_64_1024", "utm30lx_sweeping"}) {
    add_target_check(name, section);
  }
  add_deskew_rows(section.rows);
  add_spread_rows(section.rows);
  return section;
}

}  // namespace plumbline
