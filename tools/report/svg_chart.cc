#include "tools/report/svg_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tools/formats/number_text.h"
#include "tools/report/markup.h"
#include "tools/report/svg_axes.h"

namespace plumbline {
namespace {

constexpr double kTop = 12.0;
constexpr double kBottomMargin = 28.0;
constexpr std::size_t kMaxPoints = 1500;

ChartSeries in_decades(ChartSeries series) {
  for (double& y : series.y) y = y > 0.0 ? std::log10(y) : std::numeric_limits<double>::quiet_NaN();
  return series;
}

ChartRange padded(ChartRange range) {
  const double span = range.max - range.min;
  const double pad = span > 0.0 ? 0.06 * span : std::max(1e-6, 0.1 * std::abs(range.max));
  // An axis that starts at zero stays there.
  return {range.min == 0.0 && span > 0.0 ? 0.0 : range.min - pad, range.max + pad};
}

ChartRange y_range(const std::vector<ChartSeries>& series) {
  ChartRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const ChartSeries& line : series) {
    for (const double y : line.y) {
      if (!std::isfinite(y)) continue;
      range.min = std::min(range.min, y);
      range.max = std::max(range.max, y);
    }
  }
  return range.min > range.max ? ChartRange{0.0, 1.0} : padded(range);
}

std::string polyline(const ChartSeries& series, const ChartScale& to_x, const ChartScale& to_y) {
  std::string path = "<path class=\"line " + series.css_class + "\" d=\"";
  bool pen_down = false;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const double y = to_y(series.y[i]);
    if (!std::isfinite(y)) {
      pen_down = false;
      continue;
    }
    path += pen_down ? 'L' : 'M';
    append_fixed(path, to_x(series.x[i]), 1);
    append_fixed(path += ' ', y, 1);
    // A lone point still shows, by its line cap.
    if (!pen_down) path += "h0";
    pen_down = true;
  }
  return path + "\"/>";
}

std::string power_of_ten(double exponent) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  if (exponent < 0.0) text += "⁻";
  for (const char digit : std::to_string(std::lround(std::abs(exponent)))) text += kDigits[digit - '0'];
  return text;
}

std::string y_axis(const ChartRange& range, double bottom, bool logarithmic) {
  const ChartScale scale(range, bottom, kTop);
  std::vector<double> ticks = axis_ticks(range, 4);
  if (logarithmic) std::erase_if(ticks, [](double tick) { return tick != std::round(tick); });
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  std::string svg;
  for (const double tick : ticks) {
    svg += svg_line(kChartLeft, scale(tick), kChartRight, scale(tick), tick == 0.0 && !logarithmic ? "axis" : "grid");
    svg +=
        svg_text(kChartLeft - 6.0, scale(tick) + 5.0, "end", logarithmic ? power_of_ten(tick) : tick_text(tick, step));
  }
  return svg;
}

std::string legend_of(const LineChart& chart) {
  std::vector<std::pair<std::string, std::string>> entries;
  for (const ChartSeries& line : chart.series) {
    if (!line.label.empty()) entries.emplace_back(line.css_class, line.label);
  }
  return entries.empty() ? "" : legend(entries);
}

}  // namespace

ChartSeries thinned(const ChartSeries& series, std::size_t max_points) {
  const std::size_t count = series.x.size();
  if (count <= max_points || max_points < 3) return series;
  ChartSeries thin{series.label, series.css_class, {}, {}};
  const auto keep = [&](std::size_t i) {
    thin.x.push_back(series.x[i]);
    thin.y.push_back(series.y[i]);
  };
  const std::size_t buckets = max_points / 3;
  for (std::size_t b = 0; b < buckets; ++b) {
    std::optional<std::size_t> low;
    std::optional<std::size_t> high;
    std::optional<std::size_t> gap;
    for (std::size_t i = b * count / buckets; i < (b + 1) * count / buckets; ++i) {
      if (!std::isfinite(series.y[i])) {
        gap = i;
        continue;
      }
      if (!low || series.y[i] < series.y[*low]) low = i;
      if (!high || series.y[i] > series.y[*high]) high = i;
    }
    if (low) keep(std::min(*low, *high));
    if (low && *low != *high) keep(std::max(*low, *high));
    // A break in the line must survive as a break.
    if (gap) keep(*gap);
  }
  return thin;
}

std::string line_chart(const LineChart& chart) {
  std::vector<ChartSeries> lines;
  for (const ChartSeries& series : chart.series) {
    lines.push_back(thinned(chart.logarithmic ? in_decades(series) : series, kMaxPoints));
  }
  const ChartRange y = y_range(lines);
  const double bottom = chart.height - kBottomMargin;
  const ChartScale to_x(chart.x, kChartLeft, kChartRight);
  const ChartScale to_y(y, bottom, kTop);

  std::string html = "<figure class=\"chart\"><figcaption>" + escape_markup(chart.caption);
  if (!chart.unit.empty()) html += " <small>" + escape_markup(chart.unit) + "</small>";
  html += "</figcaption>";
  html += legend_of(chart) + svg_open(kChartWidth, chart.height, chart.caption);
  html += x_axis(chart.x, kTop, bottom, chart.x_label) + y_axis(y, bottom, chart.logarithmic);
  for (const ChartSeries& line : lines) html += polyline(line, to_x, to_y);
  return html + "</svg></figure>";
}

}  // namespace plumbline
