#include "tools/report/point_chart.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/report/markup.h"
#include "tools/report/svg_axes.h"

namespace plumbline {
namespace {

constexpr double kHeight = 240.0;
constexpr double kPlotTop = 10.0;
constexpr double kBottom = 190.0;
constexpr double kInset = 26.0;      // of the first and last setting from the plot's edges
constexpr double kApart = 7.0;       // between dots of several series at one setting
constexpr double kLetter = 7.0;      // width of one
constexpr double kRow = 24.0;        // of a chart whose settings are words: height of a setting with one series
constexpr double kRowsLeft = 300.0;  // its plot's edge, right of the words
constexpr std::size_t kLongestRowLabel = 30;
constexpr double kTickApart = 58.0;  // labels closer than this would run into each other

std::string svg_dot(double x, double y, const std::string& css_class) {
  return "<circle class=\"dot " + css_class + "\" cx=\"" + coordinate(x) + "\" cy=\"" + coordinate(y) + "\" r=\"4\"/>";
}

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

/// Of a setting in words, whose braces and quotes say nothing: as much as there is room for, all of it when pointed at.
std::string row_label(double y, const std::string& words) {
  std::string text;
  std::copy_if(words.begin(), words.end(), std::back_inserter(text),
               [](char c) { return c != '{' && c != '}' && c != '"'; });
  if (text.size() > kLongestRowLabel) {
    std::size_t end = kLongestRowLabel;
    while ((static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // not within a character
    text = text.substr(0, end) + "…";
  }
  return "<g><title>" + escape_markup(words) + "</title>" + svg_text(kRowsLeft - 10.0, y + 5.0, "end", text) + "</g>";
}

/// Whether the settings are words that would run into each other along an axis.
bool needs_rows(const PointChart& chart) {
  if (chart.joined || chart.style == PointChart::Style::kBand || chart.ticks.size() < 2) return false;
  const double room = (kChartRight - kChartLeft - 2.0 * kInset) / static_cast<double>(chart.ticks.size() - 1);
  return std::any_of(chart.ticks.begin(), chart.ticks.end(), [&](const PointChart::Tick& tick) {
    return kLetter * static_cast<double>(tick.label.size()) > room;
  });
}

/// A row per setting, values to the right.
Drawing row_chart(const PointChart& chart) {
  const double row = kRow + kApart * static_cast<double>(chart.series.size() - 1);
  const double bottom = kPlotTop + row * static_cast<double>(chart.ticks.size());
  const ChartRange range = y_range(chart);
  const ChartScale to_x(range, kRowsLeft, kChartRight - 10.0);
  Drawing drawing{chart.name, chart.caption, chart.unit, {}, kChartWidth, bottom + 48.0, {}};
  const std::vector<double> marks = axis_ticks(range, 4);
  const double step = marks.size() > 1 ? marks[1] - marks[0] : 1.0;
  const double shown = chart.percent ? 100.0 : 1.0;
  for (const double mark : marks) {
    drawing.body += svg_line(to_x(mark), kPlotTop, to_x(mark), bottom, mark == 0.0 ? "axis" : "grid");
    drawing.body += svg_text(to_x(mark), bottom + 18.0, "middle", tick_text(shown * mark, shown * step));
  }
  drawing.body += svg_text(kRowsLeft - 10.0, bottom + 40.0, "end", chart.x_label);
  const auto middle_of = [&](std::size_t tick) { return kPlotTop + row * (static_cast<double>(tick) + 0.5); };
  for (std::size_t t = 0; t < chart.ticks.size(); ++t) drawing.body += row_label(middle_of(t), chart.ticks[t].label);
  for (std::size_t i = 0; i < chart.series.size(); ++i) {
    const PointChart::Series& series = chart.series[i];
    const double offset = kApart * (static_cast<double>(i) - 0.5 * static_cast<double>(chart.series.size() - 1));
    for (const auto& point : series.points) {
      const auto tick = std::find_if(chart.ticks.begin(), chart.ticks.end(),
                                     [&](const PointChart::Tick& at) { return at.x == point.x; });
      const double y = middle_of(static_cast<std::size_t>(tick - chart.ticks.begin())) + offset;
      drawing.body += svg_line(to_x(point.y.low), y, to_x(point.y.high), y, "line " + series.css_class);
      drawing.body += svg_dot(to_x(point.y.value), y, series.css_class);
    }
    drawing.legend.emplace_back(series.css_class, series.label);
  }
  return drawing;
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
    svg += svg_dot(x, to_y(point.y.value), series.css_class);
  }
  return svg;
}

}  // namespace

Drawing point_chart(const PointChart& chart) {
  if (needs_rows(chart)) return row_chart(chart);
  const ChartRange range = y_range(chart);
  const ChartScale to_x = x_scale(chart);
  const ChartScale to_y(range, kBottom, kPlotTop);
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
