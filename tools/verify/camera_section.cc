#include "tools/verify/camera_section.h"

#include <cmath>

#include "scenarios/catalogue.h"
#include "tools/formats/number_text.h"
#include "tools/report/svg_chart.h"
#include "tools/verify/moving_edge.h"
#include "tools/verify/photon_transfer.h"

namespace plumbline {
namespace {

constexpr double kMaxGainError = 0.05;
constexpr double kMaxReadNoiseError = 0.10;
constexpr double kMaxFullWellError = 0.05;
constexpr double kMaxBlurError_px = 0.2;

VerifyRow figure_row(const std::string& what, double found, double figure, double bound, const std::string& unit) {
  const double error = found / figure - 1.0;
  return {what, fixed_text(figure, 1) + unit + " within " + fixed_text(100.0 * bound, 0) + " %",
          fixed_text(found, 1) + unit + ", " + fixed_text(100.0 * error, 2) + " %", std::abs(error) <= bound};
}

void add_rows(const std::string& camera, const SensorChip& chip, const PhotonTransfer& found,
              std::vector<VerifyRow>& rows) {
  rows.push_back(figure_row(camera + ": gain from the photon transfer curve", found.electrons_per_count,
                            electrons_per_count(chip, found.gain), kMaxGainError, " e-/count"));
  rows.push_back(figure_row(camera + ": read noise", found.read_noise_electrons, chip.read_noise_electrons,
                            kMaxReadNoiseError, " e-"));
  rows.push_back(figure_row(camera + ": full well", found.full_well_electrons, chip.full_well_electrons,
                            kMaxFullWellError, " e-"));
}

std::string transfer_chart(const std::string& camera, const SensorChip& chip, const PhotonTransfer& found) {
  ChartSeries measured{"measured", "c0", {}, {}};
  ChartSeries model{"model, up to the full well", "truth", {}, {}};
  const double per_count = electrons_per_count(chip, found.gain);
  const double read_counts = chip.read_noise_electrons / per_count;
  for (const FlatField& field : found.fields) {
    const double signal = field.mean - found.dark.mean;
    measured.x.push_back(signal);
    measured.y.push_back(field.variance);
    model.x.push_back(signal);
    model.y.push_back(signal < chip.full_well_electrons / per_count ? signal / per_count + read_counts * read_counts
                                                                    : std::nan(""));
  }
  LineChart chart;
  chart.caption = camera + ", photon transfer: variance over signal";
  chart.unit = "counts²";
  chart.x = {0.0, measured.x.back()};
  chart.x_label = "signal [counts of 10 bits]";
  chart.series = {measured, model};
  return line_chart(chart);
}

void add_blur(VerifySection& section) {
  constexpr double kExposure_s = 6e-3;
  ChartSeries measured{"measured", "c0", {}, {}};
  ChartSeries expected{"speed times exposure", "truth", {}, {}};
  for (const double speed_mps : {2.0, 4.0, 6.0, 8.0, 10.0}) {
    const BlurCheck check = check_blur(speed_mps, kExposure_s);
    const std::string where = "wide640: blur of an edge at 2 m, 6 ms of exposure and " + fixed_text(speed_mps, 0);
    section.rows.push_back({where + " m/s",
                            fixed_text(check.expected_px, 2) + " px within " + fixed_text(kMaxBlurError_px, 1) + " px",
                            fixed_text(check.measured_px, 2) + " px",
                            std::abs(check.measured_px - check.expected_px) <= kMaxBlurError_px});
    measured.x.push_back(speed_mps);
    measured.y.push_back(check.measured_px);
    expected.x.push_back(speed_mps);
    expected.y.push_back(check.expected_px);
  }
  LineChart chart;
  chart.caption = "wide640, length of the motion blur";
  chart.unit = "px";
  chart.x = {measured.x.front(), measured.x.back()};
  chart.x_label = "speed [m/s]";
  chart.series = {measured, expected};
  section.charts += line_chart(chart);
}

}  // namespace

VerifySection camera_section() {
  VerifySection section;
  section.title = "Cameras";
  section.note =
      "Flat fields on the 10-bit output, at the gain that puts the full well at 70 % of the converter's range, as EMVA "
      "1288 evaluates them; and an edge that passes by.";
  section.charts = "<div class=\"pair\">";
  for (const std::string& name : catalogue_names("camera")) {
    const SensorChip chip = catalogue_camera(name).chip;
    const PhotonTransfer found = measure_photon_transfer(chip);
    add_rows(name, chip, found, section.rows);
    section.charts += transfer_chart(name, chip, found);
  }
  add_blur(section);
  section.charts += "</div>";
  return section;
}

}  // namespace plumbline
