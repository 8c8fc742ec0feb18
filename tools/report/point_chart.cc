#include "tools/report/point_chart.h"

#include <algorithm>
#include <cmath>

#include "tools/report/svg_axes.h"

namespace plumbline {
namespace {

constexpr double kHeight = 240.0;
constexpr double kTop = 10.0;
constexpr double kBottom = 190.0;
constexpr double kInset = 26.0;      // of the first and last setting from the plot's edges
constexpr double kApart = 7.0;       // between dots of several series at one setting
constexpr double kTickApart = 58.0;  // labels closer than this would run into each other

ChartRange y_range(const PointChart& chart) {
  if (chart.percent) return {0.0, 1.0};
  double low = 1e300;
  double high = -1e300;
  for (const auto& series : chart.series) {
    for (const auto& point : series.points) {
      low = std::min(low, point.y.low);
      high = std::max(high, point.y.high);
    }
  }
  if (low > high) return {0.0, 1.0};
  if (chart.from_zero) low = std::min(low, 0.0);
  const double pad = high > low ? 0.06 * (high - low) : std::max(0.1 * std::abs(high), 1e-6);
  return {low == 0.0 ? 0.0 : low - pad, high + pad};
}

ChartScale x_scale(const PointChart& chart) {
  if (chart.ticks.empty()) return {{0.0, 1.0}, kChartLeft + kInset, kChartRight - kInset};
  const ChartRange range{chart.ticks.front().x, chart.ticks.back().x};
  if (range.min == range.max) return {range, 0.5 * (kChartLeft + kChartRight), 0.0};
  return {range, kChartLeft + kInset, kChartRight - kInset};
}

std::string y_axis(const PointChart& chart, const ChartRange& range, const ChartScale& to_y) {
  const std::vector<double> ticks = axis_ticks(range, 4);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  const double shown = chart.percent ? 100.0 : 1.0;
  std::string svg;
  for (const double tick : ticks) {
    svg += svg_line(kChartLeft, to_y(tick), kChartRight, to_y(tick), tick == 0.0 ? "axis" : "grid");
    svg += svg_text(kChartLeft - 6.0, to_y(tick) + 5.0, "end", tick_text(shown * tick, shown * step));
  }
  return svg;
}

std::string x_axis_of(const PointChart& chart, const ChartScale& to_x) {
  std::string svg = svg_line(kChartLeft, kBottom, kChartRight, kBottom, "axis");
  double last_label = -1e9;
  for (const auto& tick : chart.ticks) {
    const double x = to_x(tick.x);
    svg += svg_line(x, kBottom, x, kBottom + 4.0, "axis");
    if (x - last_label < kTickApart) continue;
    svg += svg_text(x, kBottom + 20.0, "middle", tick.label);
    last_label = x;
  }
  return svg + svg_text(0.5 * (kChartLeft + kChartRight), kHeight - 8.0, "middle", chart.x_label);
}

std::string place(double x, double y) { return coordinate(x) + " " + coordinate(y); }

std::string line_through(const PointChart::Series& series, const ChartScale& to_x, const ChartScale& to_y,
                         double offset) {
  std::string path;
  for (const auto& point : series.points) {
    path += path.empty() ? 'M' : 'L';
    path += place(to_x(point.x) + offset, to_y(point.y.value));
  }
  return path.empty() ? "" : "<path class=\"line " + series.css_class + "\" d=\"" + path + "\"/>";
}

std::string band(const PointChart::Series& series, const ChartScale& to_x, const ChartScale& to_y) {
  std::string path;
  for (const auto& point : series.points) {
    path += path.empty() ? 'M' : 'L';
    path += place(to_x(point.x), to_y(point.y.high));
  }
  for (auto point = series.points.rbegin(); point != series.points.rend(); ++point) {
    path += 'L';
    path += place(to_x(point->x), to_y(point->y.low));
  }
  return path.empty() ? "" : "<path class=\"band " + series.css_class + "\" d=\"" + path + "Z\"/>";
}

std::string whiskers(const PointChart::Series& series, const ChartScale& to_x, const ChartScale& to_y, double offset) {
  std::string svg;
  for (const auto& point : series.points) {
    const double x = to_x(point.x) + offset;
    svg += svg_line(x, to_y(point.y.low), x, to_y(point.y.high), "line " + series.css_class);
    svg += "<circle class=\"dot " + series.css_class + "\" cx=\"" + coordinate(x) + "\" cy=\"" +
           coordinate(to_y(point.y.value)) + "\" r=\"4\"/>";
  }
  return svg;
}

}  // namespace

Drawing point_chart(const PointChart& chart) {
  const ChartRange range = y_range(chart);
  const ChartScale to_x = x_scale(chart);
  const ChartScale to_y(range, kBottom, kTop);
  Drawing drawing{chart.name, chart.caption, chart.unit, {}, kChartWidth, kHeight, {}};
  drawing.body = y_axis(chart, range, to_y) + x_axis_of(chart, to_x);
  const auto count = static_cast<double>(chart.series.size());
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const PointChart::Series& series = chart.series[i];
    const bool is_band = chart.style == PointChart::Style::kBand;
    const double offset = is_band ? 0.0 : kApart * (static_cast<double>(i) - 0.5 * (count - 1.0));
    if (is_band) drawing.body += band(series, to_x, to_y);
    if (chart.joined || is_band) drawing.body += line_through(series, to_x, to_y, offset);
    if (!is_band) drawing.body += whiskers(series, to_x, to_y, offset);
    drawing.legend.emplace_back(series.css_class, series.label);
  }
  return drawing;
}

}  // namespace plumbline
