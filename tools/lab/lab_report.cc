#include "tools/lab/lab_report.h"

#include <algorithm>
#include <array>

#include "tools/evaluation/quantile.h"
#include "tools/formats/number_text.h"
#include "tools/report/markup.h"
#include "tools/report/point_chart.h"

namespace plumbline {
namespace {

constexpr int kDigits = 6;
constexpr std::size_t kMostCurves = 4;  // told apart in one chart

std::string number(const std::optional<double>& value) {
  std::string text;
  if (value) append_general(text, *value, kDigits);
  return text;
}

std::optional<double> of_choice(const DetectorScore& score, double ThresholdChoice::*figure) {
  return score.choice ? std::optional((*score.choice).*figure) : std::nullopt;
}
std::optional<double> at_choice(const DetectorScore& score, double RocPoint::*figure) {
  return score.choice ? std::optional(score.choice->at.*figure) : std::nullopt;
}

Drawing roc_chart(const std::vector<DetectorScore>& scores) {
  PointChart chart;
  chart.name = "detectors_roc";
  chart.caption = "Degenerate scans found against false alarms";
  chart.unit = "%";
  chart.x_label = "false alarms [% of the well-determined scans]";
  chart.percent = true;
  chart.style = PointChart::Style::kBand;
  for (const int percent : {0, 20, 40, 60, 80, 100}) chart.ticks.push_back({percent / 100.0, std::to_string(percent)});
  std::vector<const DetectorScore*> best;
  for (const DetectorScore& score : scores) {
    if (score.area) best.push_back(&score);
  }
  std::stable_sort(best.begin(), best.end(),
                   [](const DetectorScore* a, const DetectorScore* b) { return *a->area > *b->area; });
  if (best.size() > kMostCurves) {
    // The estimator's own is shown in any case.
    const auto own =
        std::find_if(best.begin(), best.end(), [](const DetectorScore* s) { return s->in_use.has_value(); });
    if (own != best.end() && own - best.begin() >= static_cast<std::ptrdiff_t>(kMostCurves)) {
      best[kMostCurves - 1] = *own;
    }
    best.resize(kMostCurves);
  }
  for (std::size_t i = 0; i < best.size(); ++i) {
    PointChart::Series series{best[i]->name, "c" + std::to_string(i), {{0.0, {0.0, 0.0, 0.0}}}};
    for (const RocPoint& point : best[i]->roc) {
      series.points.push_back({point.false_alarms, {point.hits, point.hits, point.hits}});
    }
    series.points.push_back({1.0, {1.0, 1.0, 1.0}});
    chart.series.push_back(std::move(series));
  }
  return point_chart(chart);
}

std::string detector_table(const std::vector<DetectorScore>& scores) {
  std::string html =
      "<div class=\"card scroll wide\"><table><thead><tr><th>detector</th><th>area under "
      "ROC</th><th>threshold</th><th>margin</th>"
      "<th>found [%]</th><th>false alarms [%]</th><th>angle [°]</th><th>latency [scans]</th></tr></thead><tbody>";
  const auto percent = [](const std::optional<double>& share) {
    return share ? std::optional(100.0 * *share) : std::nullopt;
  };
  for (const DetectorScore& score : scores) {
    html += "<tr><td>" + escape_markup(score.name) + "</td>";
    for (const std::string& text :
         {shown(score.area), shown(at_choice(score, &RocPoint::threshold)),
          shown(of_choice(score, &ThresholdChoice::margin)), shown(percent(at_choice(score, &RocPoint::hits))),
          shown(percent(at_choice(score, &RocPoint::false_alarms))), shown(score.angle_deg),
          shown(score.latency_scans) + " (" + std::to_string(score.onsets_missed) + " of " +
              std::to_string(score.onsets) + " missed)"}) {
      html += "<td>" + text + "</td>";
    }
    html += "</tr>";
  }
  return html + "</tbody></table></div>";
}

std::vector<MitigationFigures> compare_mitigations(const std::vector<std::vector<MitigationRow>>& runs) {
  std::vector<MitigationFigures> all;
  for (const Mitigation mitigation : kMitigations) {
    MitigationFigures figures;
    figures.mitigation = to_string(mitigation);
    std::array<std::vector<double>, 2> drifts;  // of runs without degenerate scans, and with
    std::array<std::vector<double>, 2> progresses;
    for (const std::vector<MitigationRow>& run : runs) {
      for (const MitigationRow& row : run) {
        if (row.mitigation != figures.mitigation) continue;
        const std::size_t kind = row.degenerate > 0 ? 1 : 0;
        (kind == 1 ? figures.degenerate_runs : figures.well_runs) += 1;
        if (row.drift_percent) drifts[kind].push_back(*row.drift_percent);
        if (row.progress_ratio) progresses[kind].push_back(*row.progress_ratio);
      }
    }
    figures.well_drift_percent = quantile(drifts[0], 0.5);
    figures.well_progress = quantile(progresses[0], 0.5);
    figures.degenerate_drift_percent = quantile(drifts[1], 0.5);
    figures.degenerate_progress = quantile(progresses[1], 0.5);
    all.push_back(std::move(figures));
  }
  return all;
}

std::string mitigation_table(const std::vector<MitigationFigures>& mitigations) {
  std::string html =
      "<h2>Mitigations</h2><p class=\"note\">Scan matching alone, from a prediction with the errors of dead reckoning "
      "(1 % of the way and a few millimetres a scan): medians over the runs in which some scan is degenerate, and over "
      "the others.</p><div class=\"card scroll wide\"><table><thead><tr><th>mitigation</th><th>drift where degenerate "
      "[%]</th>"
      "<th>progress ratio there</th><th>drift elsewhere [%]</th><th>progress ratio there</th></tr></thead><tbody>";
  for (const MitigationFigures& one : mitigations) {
    html += "<tr><td>" + escape_markup(one.mitigation) + "</td><td>" + shown(one.degenerate_drift_percent) +
            "</td><td>" + shown(one.degenerate_progress) + "</td><td>" + shown(one.well_drift_percent) + "</td><td>" +
            shown(one.well_progress) + "</td></tr>";
  }
  return html + "</tbody></table></div>";
}

}  // namespace

LabFindings lab_findings(const SweepPlan& plan, const std::filesystem::path& root) {
  std::vector<std::vector<LabRow>> runs;
  std::vector<std::vector<MitigationRow>> mitigated;
  for (const PlannedRun& run : plan.runs) {
    runs.push_back(read_lab_csv(root / "runs" / run.key / "detectors.csv"));
    mitigated.push_back(read_mitigations_csv(root / "runs" / run.key / "mitigations.csv"));
  }
  LabFindings findings;
  for (std::size_t i = 0; i < kDetectors.size(); ++i) {
    const bool wanted =
        std::find(plan.detectors.begin(), plan.detectors.end(), to_string(kDetectors[i])) != plan.detectors.end();
    if (wanted) findings.detectors.push_back(score_detector(i, runs));
  }
  findings.registration = registration_efficiency(runs);
  findings.mitigations = compare_mitigations(mitigated);
  return findings;
}

std::string detectors_csv(const LabFindings& findings) {
  std::string text =
      "detector,degenerate_scans,well_scans,grey_scans,area,threshold,margin,hits,false_alarms,angle_deg,latency_scans,"
      "onsets,onsets_missed,error_over_selected,error_over_all\n";
  for (const DetectorScore& score : findings.detectors) {
    text += score.name + "," + std::to_string(score.degenerate) + "," + std::to_string(score.well) + "," +
            std::to_string(score.grey);
    for (const auto& value : {score.area, at_choice(score, &RocPoint::threshold),
                              of_choice(score, &ThresholdChoice::margin), at_choice(score, &RocPoint::hits),
                              at_choice(score, &RocPoint::false_alarms), score.angle_deg, score.latency_scans}) {
      text += ",";
      text += number(value);
    }
    text += "," + std::to_string(score.onsets) + "," + std::to_string(score.onsets_missed) + ",,\n";
  }
  return text + "registration,," + std::to_string(findings.registration.scans) + ",,,,,,,,,,," +
         number(findings.registration.over_selected) + "," + number(findings.registration.over_all) + "\n";
}

std::string mitigations_csv(const LabFindings& findings) {
  std::string text =
      "mitigation,degenerate_runs,degenerate_drift_percent,degenerate_progress_ratio,well_runs,well_drift_percent,"
      "well_progress_ratio\n";
  for (const MitigationFigures& one : findings.mitigations) {
    text += one.mitigation + "," + std::to_string(one.degenerate_runs) + "," + number(one.degenerate_drift_percent) +
            "," + number(one.degenerate_progress) + "," + std::to_string(one.well_runs) + "," +
            number(one.well_drift_percent) + "," + number(one.well_progress) + "\n";
  }
  return text;
}

std::string lab_section(const LabFindings& findings, std::vector<Drawing>& charts) {
  if (findings.detectors.empty()) return {};
  const DetectorScore& any = findings.detectors.front();
  std::string note =
      "Against the exact information of every scan's true returns: " + std::to_string(any.degenerate) +
      " scans with a degenerate direction, " + std::to_string(any.well) + " well determined, " +
      std::to_string(any.grey) +
      " in the grey zone, which are left out. The threshold separates best; the margin is "
      "the factor by which scores may be off before it does not. The angle is the largest between the true and the "
      "found directions, rotations scaled by the mean range, median over degenerate scans.";
  for (const DetectorScore& score : findings.detectors) {
    if (!score.in_use) continue;
    note += " Scan matching remaps below " + readable_text(score.in_use->threshold) + " of " + score.name +
            ": there it finds " + readable_text(100.0 * score.in_use->hits) + " % of the degenerate scans, with " +
            readable_text(100.0 * score.in_use->false_alarms) + " % false alarms.";
  }
  if (findings.registration.over_selected) {
    note += " Registered on the true surfaces, the matched points err " +
            readable_text(*findings.registration.over_selected) + " times their Cramér–Rao bound, which is " +
            readable_text(*findings.registration.over_all) + " times that of all returns (root mean square over " +
            std::to_string(findings.registration.scans) + " well-determined scans).";
  }
  charts.push_back(roc_chart(findings.detectors));
  return "<h2>Degeneracy detectors</h2><p class=\"note\">" + escape_markup(note) + "</p><div class=\"pair\">" +
         figure_html(charts.back()) + "</div>" + detector_table(findings.detectors) +
         mitigation_table(findings.mitigations);
}

}  // namespace plumbline
