#include "tools/verify/imu_section.h"

#include <algorithm>
#include <cmath>

#include "scenarios/catalogue.h"
#include "tools/formats/number_text.h"
#include "tools/report/svg_chart.h"
#include "tools/verify/imu_check.h"

namespace plumbline {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kMaxDensityError = 0.03;
constexpr double kMaxBiasError = 0.10;

std::string percent(double share, int decimals) { return fixed_text(100.0 * share, decimals) + " %"; }

VerifyRow error_row(const std::string& check, double gyro_error, double accel_error, double bound) {
  return {check, "within " + percent(bound, 0), "gyro " + percent(gyro_error, 2) + ", accel " + percent(accel_error, 2),
          std::max(gyro_error, accel_error) <= bound};
}

void add_rows(const ImuCheck& check, std::vector<VerifyRow>& rows) {
  const std::string name = check.model.name + ": ";
  const auto worst = [&](const auto& given_back, auto figure) {
    return std::array{worst_error(check.gyro.*given_back, check.gyro.figures.*figure),
                      worst_error(check.accel.*given_back, check.accel.figures.*figure)};
  };
  const auto density = worst(&TriadCheck::density, &NoiseFigures::density);
  const auto instability = worst(&TriadCheck::bias_instability, &NoiseFigures::bias_instability);
  const auto walk = worst(&TriadCheck::random_walk, &NoiseFigures::random_walk);
  rows.push_back(
      error_row(name + "noise density N from 2 h at rest, worst axis", density[0], density[1], kMaxDensityError));
  rows.push_back(error_row(name + "bias instability B from 8 h of flicker noise alone, worst axis", instability[0],
                           instability[1], kMaxBiasError));
  rows.push_back(
      error_row(name + "rate random walk K from 2 h of it alone, worst axis", walk[0], walk[1], kMaxBiasError));
  const double within =
      0.5 * (share_within(check.gyro, check.gyro.joint_band) + share_within(check.accel, check.accel.joint_band));
  const double within_own =
      0.5 * (share_within(check.gyro, check.gyro.band) + share_within(check.accel, check.accel.band));
  rows.push_back({name + "six 2 h Allan curves inside the model's 95 % band of all units' curves together",
                  "all points", percent(within, 1) + "; of each point's own 95 % band " + percent(within_own, 1),
                  within == 1.0});
}

ChartSeries line(const std::string& label, const std::string& css_class) { return {label, css_class, {}, {}}; }

std::string allan_chart(const ImuModel& model, const std::string& what, const std::string& unit,
                        const TriadCheck& check) {
  std::vector<ChartSeries> axes{line("x", "c0"), line("y", "c1"), line("z", "c2")};
  ChartSeries expected = line("model", "truth");
  ChartSeries low = line("95 % band of each point", "estimate");
  ChartSeries high = line("", "estimate");
  const auto add = [](ChartSeries& series, double tau_s, double variance) {
    series.x.push_back(std::log10(tau_s));
    series.y.push_back(std::sqrt(variance));
  };
  for (std::size_t i = 0; i < check.expected.size(); ++i) {
    const double tau_s = check.curves[0][i].tau_s;
    for (std::size_t axis = 0; axis < 3; ++axis) add(axes[axis], tau_s, check.curves[axis][i].variance);
    add(expected, tau_s, check.expected[i].variance);
    add(low, tau_s, check.band[i].low);
    add(high, tau_s, check.band[i].high);
  }
  LineChart chart;
  chart.caption = model.name + ", " + what;
  chart.unit = unit;
  chart.x = {expected.x.front(), expected.x.back()};
  chart.x_label = "log10(tau / s)";
  chart.logarithmic = true;
  chart.series = {low, high, axes[0], axes[1], axes[2], expected};
  return line_chart(chart);
}

}  // namespace

VerifySection imu_section() {
  VerifySection section;
  section.title = "Inertial units";
  section.note =
      "Two hours at rest with every effect on, against the Allan variance that the model's processes must have; and "
      "logs "
      "of single processes, which give back their figures.";
  const std::vector<std::string> names = catalogue_names("imu");
  for (const std::string& name : names) {
    const ImuCheck check = check_imu(catalogue_imu(name), names.size(), kSeed);
    add_rows(check, section.rows);
    section.charts += "<div class=\"pair\">" +
                      allan_chart(check.model, "Allan deviation of the gyroscopes", "rad/s", check.gyro) +
                      allan_chart(check.model, "Allan deviation of the accelerometers", "m/s²", check.accel) + "</div>";
  }
  return section;
}

}  // namespace plumbline
