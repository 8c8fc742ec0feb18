#include "tools/mount/mount_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "tools/formats/number_text.h"
#include "tools/mount/mount_pictures.h"
#include "tools/mount/mount_tables.h"
#include "tools/report/heat_map.h"
#include "tools/report/markup.h"
#include "tools/report/page_parts.h"
#include "tools/report/point_chart.h"

namespace plumbline {
namespace {

/// A figure of a mounting, to be drawn over the angles; less is better.
struct MountFigure {
  std::string name;
  std::string caption;
  std::string unit;
  std::function<std::optional<double>(const Mounting&)> value;
  bool more_is_better = false;
};

std::vector<MountFigure> figures() {
  return {
      {"measured_drift", "Measured drift, median over seeds", "%",
       [](const Mounting& m) { return m.drift_percent ? std::optional(m.drift_percent->value) : std::nullopt; }},
      {"predicted_drift", "Predicted growth of the error", "% at best",
       [](const Mounting& m) { return std::optional(m.predicted.drift_percent); }},
      {"worst_direction", "Worst direction's bound, 90th percentile of scans", "limits",
       [](const Mounting& m) { return std::optional(m.predicted.worst_direction); }},
      {"degenerate_time", "Scans with a degenerate direction", "%",
       [](const Mounting& m) { return std::optional(100.0 * m.predicted.degenerate_time); }},
      {"coverage", "Surfaces about the path that the lidar sees", "%",
       [](const Mounting& m) { return std::optional(100.0 * m.predicted.coverage); }, true},
      {"own_body", "View taken up by the vehicle", "%",
       [](const Mounting& m) { return std::optional(100.0 * m.predicted.own_body_share); }},
      {"overlap", "Image that the lidar sees as well", "%",
       [](const Mounting& m) { return std::optional(100.0 * m.predicted.overlap); }, true},
  };
}

double number(const AxisValue& value) { return value.number.value_or(0.0); }

std::vector<double> settings(const MountResults& results, std::size_t axis) {
  std::set<double> values;
  for (const Mounting& mounting : results.mountings) values.insert(number(mounting.values[axis]));
  return {values.begin(), values.end()};
}

/// Over one axis: every mounting a dot.
Drawing line_over(const MountStudy& study, const MountResults& results, std::size_t axis, const MountFigure& figure) {
  PointChart chart;
  chart.name = figure.name + "_over_" + study.runs.axes[axis].key;
  chart.caption = figure.caption;
  chart.unit = figure.unit;
  chart.x_label = study.runs.axes[axis].key;
  for (const double value : settings(results, axis)) chart.ticks.push_back({value, readable_text(value)});
  chart.joined = study.runs.axes.size() == 1;
  PointChart::Series series{"", "c0", {}};
  for (const Mounting& mounting : results.mountings) {
    const auto value = figure.value(mounting);
    if (!value) continue;
    const bool has_interval = figure.name == "measured_drift" && mounting.drift_percent;
    series.points.push_back(
        {number(mounting.values[axis]), has_interval ? *mounting.drift_percent : Interval{*value, *value, *value}});
  }
  std::stable_sort(series.points.begin(), series.points.end(),
                   [](const PointChart::Point& a, const PointChart::Point& b) { return a.x < b.x; });
  chart.series = {series};
  return point_chart(chart);
}

/// Over a pair of axes: the best of the mountings that share those two settings.
Drawing map_over(const MountStudy& study, const MountResults& results, std::size_t x, std::size_t y,
                 const MountFigure& figure) {
  HeatMap map;
  map.name = figure.name + "_over_" + study.runs.axes[x].key + "_and_" + study.runs.axes[y].key;
  map.caption = figure.caption;
  map.unit = figure.unit + (study.runs.axes.size() > 2 ? ", the best of the other settings" : "");
  map.x_label = study.runs.axes[x].key;
  map.y_label = study.runs.axes[y].key;
  const std::vector<double> columns = settings(results, x);
  const std::vector<double> rows = settings(results, y);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::vector<std::vector<std::optional<double>>> best(rows.size(), std::vector<std::optional<double>>(columns.size()));
  for (const Mounting& mounting : results.mountings) {
    const auto value = figure.value(mounting);
    if (!value) continue;
    const auto row = std::lower_bound(rows.begin(), rows.end(), number(mounting.values[y])) - rows.begin();
    const auto column = std::lower_bound(columns.begin(), columns.end(), number(mounting.values[x])) - columns.begin();
    auto& cell = best[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    const bool better = !cell || (figure.more_is_better ? *value > *cell : *value < *cell);
    if (better) cell = value;
    low = std::min(low, *value);
    high = std::max(high, *value);
  }
  for (const double value : columns) map.columns.push_back(readable_text(value));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    map.rows.push_back(readable_text(rows[r]));
    map.cells.emplace_back();
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::optional<double>& value = best[r][c];
      if (!value) {
        map.cells.back().emplace_back();
        continue;
      }
      const double place = high > low ? (*value - low) / (high - low) : 0.0;
      map.cells.back().push_back(HeatMap::Cell{figure.more_is_better ? 1.0 - place : place, readable_text(*value),
                                               map.x_label + " " + map.columns[c] + ", " + map.y_label + " " +
                                                   map.rows[r] + ": " + readable_text(*value) + " " + figure.unit});
    }
  }
  return heat_map(map);
}

Drawing front_chart(const MountResults& results) {
  PointChart chart;
  chart.name = "pareto";
  chart.caption = "Drift against coverage: the front and the rest";
  chart.unit = "% drift";
  chart.x_label = "surfaces seen [%]";
  chart.joined = false;
  PointChart::Series front{"on the front", "c0", {}};
  PointChart::Series rest{"bettered in every figure", "c1", {}};
  double low = 100.0;
  double high = 0.0;
  for (const Mounting& mounting : results.mountings) {
    if (!mounting.drift_percent) continue;
    const double coverage = 100.0 * mounting.predicted.coverage;
    (mounting.is_on_front ? front : rest).points.push_back({coverage, *mounting.drift_percent});
    low = std::min(low, coverage);
    high = std::max(high, coverage);
  }
  low = std::floor(low / 5.0) * 5.0;
  high = std::max(low + 5.0, std::ceil(high / 5.0) * 5.0);
  for (double x = low; x <= high + 1e-9; x += std::max(5.0, (high - low) / 5.0)) {
    chart.ticks.push_back({x, readable_text(x)});
  }
  for (PointChart::Series* series : {&front, &rest}) {
    std::sort(series->points.begin(), series->points.end(),
              [](const PointChart::Point& a, const PointChart::Point& b) { return a.x < b.x; });
  }
  chart.series = {front, rest};
  return point_chart(chart);
}

std::string interval_text(const std::optional<Interval>& interval) {
  if (!interval) return "–";
  return readable_text(interval->value) + " (" + readable_text(interval->low) + " … " + readable_text(interval->high) +
         ")";
}

std::string ranking_text(const MountResults& results) {
  if (!results.rank_correlation) return "Too few mountings were tried to say how well the prediction ranks them.";
  std::string text =
      "Spearman's correlation of predicted and measured drift: " + interval_text(results.rank_correlation) + ".";
  if (results.ceiling) {
    text += " Two halves of the seeds agree to " + readable_text(*results.ceiling) +
            " (split-half, raised to all seeds): more than that no prediction can reach.";
  }
  return text;
}

std::string table_row(const MountStudy& study, const Mounting& mounting, bool recommended) {
  std::string html = recommended ? "<tr class=\"ok\">" : "<tr>";
  for (const AxisValue& value : mounting.values) html += "<td>" + escape_markup(value.text) + "</td>";
  const MountPrediction& p = mounting.predicted;
  for (const std::string& text :
       {readable_text(p.drift_percent), readable_text(p.worst_direction), readable_text(100.0 * p.degenerate_time),
        readable_text(100.0 * p.coverage), readable_text(100.0 * p.own_body_share), readable_text(100.0 * p.overlap),
        interval_text(mounting.drift_percent),
        mounting.tried ? std::to_string(mounting.lost) + " of " + std::to_string(mounting.runs) : std::string("–")}) {
    html += "<td>" + text + "</td>";
  }
  for (const std::string& estimator : study.runs.estimators) {
    if (estimator == study.judged) continue;
    const auto found = mounting.drift_of_others.find(estimator);
    html += "<td>" +
            interval_text(found == mounting.drift_of_others.end() ? std::nullopt : std::optional(found->second)) +
            "</td>";
  }
  const std::string word = recommended ? "recommended" : mounting.is_on_front ? "on the front" : mounting.ruled_out;
  return html + "<td>" + escape_markup(word) + "</td></tr>";
}

std::string mounting_table(const MountStudy& study, const MountResults& results) {
  std::string html = "<div class=\"wide\"><table><thead><tr>";
  for (const SweepAxis& axis : study.runs.axes) html += "<th>" + escape_markup(axis.key) + "</th>";
  for (const char* column : {"predicted drift [%]", "worst direction", "degenerate [%]", "coverage [%]", "own body [%]",
                             "overlap [%]", "measured drift [%]", "not ok"}) {
    html += std::string("<th>") + column + "</th>";
  }
  for (const std::string& estimator : study.runs.estimators) {
    if (estimator != study.judged) html += "<th>drift of " + escape_markup(estimator) + " [%]</th>";
  }
  html += "<th></th></tr></thead><tbody>";
  for (std::size_t i = 0; i < results.mountings.size(); ++i) {
    html += table_row(study, results.mountings[i], results.recommended == i);
  }
  return html + "</tbody></table></div>";
}

std::string charts_html(const MountStudy& study, const MountResults& results, std::vector<Drawing>& all) {
  std::string html = "<div class=\"pair\">";
  const auto add = [&](Drawing drawing) {
    html += figure_html(drawing);
    all.push_back(std::move(drawing));
  };
  std::vector<std::size_t> varied;
  for (std::size_t a = 0; a < study.runs.axes.size(); ++a) {
    if (settings(results, a).size() > 1) varied.push_back(a);
  }
  for (const MountFigure& figure : figures()) {
    if (varied.size() == 1) add(line_over(study, results, varied[0], figure));
    for (std::size_t i = 0; i < varied.size(); ++i) {
      for (std::size_t k = i + 1; k < varied.size(); ++k) {
        // A sample has no two mountings with one setting in common.
        add(study.runs.sample ? line_over(study, results, varied[i], figure)
                              : map_over(study, results, varied[i], varied[k], figure));
      }
    }
  }
  return html + "</div>";
}

std::string pictures_html(const MountStudy& study, const std::vector<MountView>& views) {
  std::string html;
  for (std::size_t s = 0; s < views.size() && s < study.scenarios.size(); ++s) {
    const std::string scenario = study.scenarios[s].stem().string();
    html += "<div class=\"pair\">" + lidar_view_figure(views[s].lidar, scenario + ", lidar, all round") +
            camera_view_figure(views[s].camera, scenario + ", camera") + "</div>";
  }
  return html;
}

}  // namespace

MountReport mount_report(const MountStudy& study, const MountResults& results, const std::vector<MountView>& views) {
  MountReport report;
  std::string links;
  for (const std::filesystem::path& scenario : study.scenarios) {
    const std::string name = escape_markup(scenario.stem().string());
    links += " <a href=\"runs/" + name + "/report.html\">" + name + "</a>";
  }
  const std::string charts = charts_html(study, results, report.charts);
  report.charts.push_back(front_chart(results));
  report.html = page_html(
      study.name,
      "<header><h1>" + escape_markup(study.name) + "</h1><span class=\"badge\">mounting study</span></header>" +
          heading("Recommended", reason_for(study, results)) + pictures_html(study, views) +
          heading("The front", "Mountings that no other betters in every weighted figure; intervals are 95 %.") +
          figure_html(report.charts.back()) + heading("How well the prediction ranks", ranking_text(results)) +
          heading("Over the angles",
                  "Predictions come from rays along the path and the exact information of what they meet; the measured "
                  "drift is the estimator's.") +
          charts + heading("All mountings", "Predicted for all; measured for those that the second stage tried.") +
          mounting_table(study, results) + "<p class=\"note\">The runs, by scenario:" + links + "</p>");
  return report;
}

}  // namespace plumbline
