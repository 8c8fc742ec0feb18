#include <algorithm>

#include "tools/report/markup.h"
#include "tools/report/svg_axes.h"

namespace plumbline {
namespace {

constexpr double kStripHeight = 18.0;
constexpr double kStripPitch = 26.0;
constexpr double kBarHeight = 20.0;
constexpr double kBarPitch = 40.0;
constexpr double kBarTextWidth = 260.0;

std::string svg_rectangle(double x, double y, double width, double height, const std::string& css_class) {
  return "<rect class=\"" + css_class + "\" x=\"" + coordinate(x) + "\" y=\"" + coordinate(y) + "\" width=\"" +
         coordinate(width) + "\" height=\"" + coordinate(height) + "\"/>";
}

/// Neighbours of one colour become one rectangle, or a long run would be thousands of them.
std::vector<StripSpan> merged(const std::vector<StripSpan>& spans) {
  std::vector<StripSpan> joined;
  for (const StripSpan& span : spans) {
    if (!joined.empty() && joined.back().css_class == span.css_class && span.from <= joined.back().to + 1e-9) {
      joined.back().to = std::max(joined.back().to, span.to);
    } else {
      joined.push_back(span);
    }
  }
  return joined;
}

}  // namespace

std::string strip_chart(const ChartRange& x, const std::vector<StripRow>& rows) {
  const double height = kStripPitch * static_cast<double>(rows.size()) + 4.0;
  const ChartScale to_x(x, kChartLeft, kChartRight);
  std::string html = "<figure class=\"chart strips\">" + svg_open(kChartWidth, height, "module status over time");
  double y = 4.0;
  for (const StripRow& row : rows) {
    html += svg_text(kChartLeft - 6.0, y + kStripHeight - 4.0, "end", row.label);
    html += svg_rectangle(kChartLeft, y, kChartRight - kChartLeft, kStripHeight, "nothing");
    for (const StripSpan& span : merged(row.spans)) {
      const double from = std::clamp(to_x(span.from), kChartLeft, kChartRight);
      const double to = std::clamp(to_x(span.to), kChartLeft, kChartRight);
      html += svg_rectangle(from, y, std::max(to - from, 0.2), kStripHeight, span.css_class);
    }
    y += kStripPitch;
  }
  return html + "</svg></figure>";
}

std::string bar_chart(const std::vector<Bar>& bars) {
  double longest = 0.0;
  for (const Bar& bar : bars) longest = std::max({longest, bar.value, bar.mark});
  const ChartScale to_x({0.0, longest > 0.0 ? longest : 1.0}, kChartLeft, kChartWidth - kBarTextWidth);
  std::string html = "<figure class=\"chart\">";
  html += svg_open(kChartWidth, kBarPitch * static_cast<double>(bars.size()), "time per message");
  double y = (kBarPitch - kBarHeight) / 2.0;
  for (const Bar& bar : bars) {
    const double middle = y + kBarHeight / 2.0;
    html += svg_text(kChartLeft - 6.0, middle + 5.0, "end", bar.label);
    html += svg_rectangle(kChartLeft, y, std::max(to_x(bar.value) - kChartLeft, 1.0), kBarHeight, "bar");
    html += svg_line(kChartLeft, middle, to_x(bar.mark), middle, "whisker");
    html += svg_line(to_x(bar.mark), y + 3.0, to_x(bar.mark), y + kBarHeight - 3.0, "whisker");
    html += svg_text(std::max(to_x(bar.value), to_x(bar.mark)) + 8.0, middle + 5.0, "start", bar.text);
    y += kBarPitch;
  }
  return html + "</svg></figure>";
}

std::string legend(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string html = "<div class=\"legend\">";
  for (const auto& [css_class, label] : entries) {
    html += "<span><i class=\"" + css_class + "\"></i>" + escape_markup(label) + "</span>";
  }
  return html + "</div>";
}

}  // namespace plumbline
