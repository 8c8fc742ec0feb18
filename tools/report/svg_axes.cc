#include "tools/report/svg_axes.h"

#include <algorithm>
#include <cmath>

#include "tools/formats/number_text.h"
#include "tools/report/markup.h"

namespace plumbline {

std::string coordinate(double value) { return fixed_text(value, 1); }

std::string svg_text(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x=\"" + coordinate(x) + "\" y=\"" + coordinate(y) + "\" text-anchor=\"" + anchor + "\">" +
         escape_markup(text) + "</text>";
}

std::string svg_line(double x1, double y1, double x2, double y2, const std::string& css_class) {
  return "<line class=\"" + css_class + "\" x1=\"" + coordinate(x1) + "\" y1=\"" + coordinate(y1) + "\" x2=\"" +
         coordinate(x2) + "\" y2=\"" + coordinate(y2) + "\"/>";
}

std::string svg_open(double width, double height, const std::string& description) {
  return "<svg role=\"img\" aria-label=\"" + escape_markup(description) + "\" viewBox=\"0 0 " + coordinate(width) +
         " " + coordinate(height) + "\">";
}

std::string x_axis(const ChartRange& range, double top, double bottom, const std::string& label) {
  const ChartScale scale(range, kChartLeft, kChartRight);
  const auto ticks = axis_ticks(range, 6);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  std::string svg = svg_line(kChartLeft, bottom, kChartRight, bottom, "axis");
  for (const double tick : ticks) {
    const double x = scale(tick);
    svg += svg_line(x, top, x, bottom, "grid");
    // The last stretch belongs to the axis's own label.
    if (x < kChartRight - 80.0) svg += svg_text(x, bottom + 19.0, "middle", tick_text(tick, step));
  }
  return svg + svg_text(kChartRight, bottom + 19.0, "end", label);
}

std::string tick_text(double value, double step) {
  if (value == 0.0) return "0";
  const double magnitude = std::max(std::abs(value), std::abs(step));
  if (magnitude >= 1e5 || std::abs(step) < 1e-4) {
    std::string text;
    append_general(text, value, 2);
    return text;
  }
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 5);
  return fixed_text(value, decimals);
}

std::vector<double> axis_ticks(const ChartRange& range, int about) {
  const double span = range.max - range.min;
  if (!(span > 0.0) || !std::isfinite(span) || about < 1) return {range.min};
  const double rough = span / about;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * decade;
  for (const double candidate : {1.0, 2.0, 5.0}) {
    if (candidate * decade >= rough) {
      step = candidate * decade;
      break;
    }
  }
  std::vector<double> ticks;
  const auto first = static_cast<long>(std::ceil(range.min / step - 1e-9));
  const auto last = static_cast<long>(std::floor(range.max / step + 1e-9));
  for (long i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * step);
  return ticks;
}

}  // namespace plumbline
