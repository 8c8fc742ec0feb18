#include "tools/report/regress_charts.h"

#include <algorithm>
#include <cmath>

#include "tools/report/point_chart.h"
#include "tools/report/svg_chart.h"

namespace plumbline {
namespace {

using RunOfPair = const MeasuredRun* RunPair::*;

struct Side {
  RunOfPair run;
  const char* label;
  const char* css_class;
};
constexpr Side kSides[] = {{&RunPair::before, "before", "c0"}, {&RunPair::after, "after", "estimate"}};

std::vector<PointChart::Tick> ticks_of(const std::vector<std::string>& names) {
  std::vector<PointChart::Tick> ticks;
  for (const std::string& name : names) ticks.push_back({static_cast<double>(ticks.size()), name});
  return ticks;
}

/// Scenarios side by side, which no line joins.
PointChart scenario_chart(const Regression& regression, const RegressFigure& figure, const std::string& name) {
  PointChart chart;
  chart.name = name + "_" + figure.key;
  chart.ticks = ticks_of(scenarios_of(regression.comparison.pairs));
  chart.joined = false;
  return chart;
}

std::vector<double> values_of(const Regression& regression, const RegressFigure& figure, const std::string& scenario,
                              RunOfPair side) {
  std::vector<double> values;
  for (const RunPair& pair : regression.comparison.pairs) {
    if (pair.before->scenario != scenario) continue;
    if (const auto value = figure.value(*(pair.*side))) values.push_back(*value);
  }
  return values;
}

/// Root mean square over the seeds of what begins in each second.
ChartSeries error_over_time(const Regression& regression, const std::string& scenario, const Side& side) {
  std::vector<double> squares;
  std::vector<double> counts;
  for (const RunPair& pair : regression.comparison.pairs) {
    if (pair.before->scenario != scenario) continue;
    const std::vector<double>& seconds = (pair.*side.run)->relative_error_by_second_m;
    if (squares.size() < seconds.size()) {
      squares.resize(seconds.size());
      counts.resize(seconds.size());
    }
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      if (!std::isfinite(seconds[i])) continue;
      squares[i] += seconds[i] * seconds[i];
      counts[i] += 1.0;
    }
  }
  ChartSeries series{side.label, side.css_class, {}, {}};
  for (std::size_t i = 0; i < squares.size(); ++i) {
    series.x.push_back(static_cast<double>(i) + 0.5);
    series.y.push_back(1e3 * std::sqrt(squares[i] / counts[i]));
  }
  return series;
}

}  // namespace

std::vector<Drawing> growth_charts(const Regression& regression) {
  std::vector<Drawing> drawings;
  for (const RegressFigure& figure : regress_figures()) {
    if (!figure.by_scenario) continue;
    PointChart chart = scenario_chart(regression, figure, "growth");
    chart.caption = figure.title;
    chart.unit = "growth, %";
    PointChart::Series series{"growth with its 95 % interval", "c0", {}};
    for (const Change& change : regression.comparison.changes) {
      if (change.figure->key != figure.key || change.scenario.empty() || !std::isfinite(change.percent.high)) continue;
      const auto tick = std::find_if(chart.ticks.begin(), chart.ticks.end(),
                                     [&](const auto& candidate) { return candidate.label == change.scenario; });
      if (tick != chart.ticks.end()) series.points.push_back({tick->x, change.percent});
    }
    chart.series.push_back(std::move(series));
    drawings.push_back(point_chart(chart));
  }
  return drawings;
}

std::vector<Drawing> before_after_charts(const Regression& regression) {
  std::vector<Drawing> drawings;
  for (const RegressFigure& figure : regress_figures()) {
    PointChart chart = scenario_chart(regression, figure, "before_after");
    chart.caption = figure.title;
    chart.unit = figure.unit;
    for (const Side& side : kSides) {
      PointChart::Series series{side.label, side.css_class, {}};
      for (const PointChart::Tick& tick : chart.ticks) {
        const auto median = bootstrap_median(values_of(regression, figure, tick.label, side.run), "regress.report");
        if (median) series.points.push_back({tick.x, *median});
      }
      chart.series.push_back(std::move(series));
    }
    drawings.push_back(point_chart(chart));
  }
  return drawings;
}

std::string error_over_time_charts(const Regression& regression) {
  std::string html;
  for (const std::string& scenario : scenarios_of(regression.comparison.pairs)) {
    LineChart chart;
    chart.caption = scenario;
    chart.unit = "mm";
    for (const Side& side : kSides) chart.series.push_back(error_over_time(regression, scenario, side));
    chart.x = {0.0, static_cast<double>(std::max<std::size_t>(1, chart.series.front().x.size()))};
    html += line_chart(chart);
  }
  return html;
}

}  // namespace plumbline
