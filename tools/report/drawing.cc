#include "tools/report/drawing.h"

#include "tools/report/markup.h"
#include "tools/report/page_style.h"
#include "tools/report/svg_axes.h"
#include "tools/report/svg_chart.h"

namespace plumbline {
namespace {

constexpr double kHeader = 34.0;
constexpr double kLegendRow = 22.0;
constexpr double kMargin = 12.0;

std::string legend_rows(const Drawing& drawing, double y) {
  std::string svg;
  for (const auto& [css_class, label] : drawing.legend) {
    svg += "<rect class=\"" + css_class + "\" x=\"" + coordinate(kChartLeft) + "\" y=\"" + coordinate(y - 10.0) +
           "\" width=\"14\" height=\"10\"/>" + svg_text(kChartLeft + 22.0, y, "start", label);
    y += kLegendRow;
  }
  return svg;
}

}  // namespace

std::string figure_html(const Drawing& drawing) {
  std::string html = "<figure class=\"chart\"><figcaption>" + escape_markup(drawing.caption);
  if (!drawing.unit.empty()) html += " <small>" + escape_markup(drawing.unit) + "</small>";
  html += "</figcaption>";
  if (!drawing.legend.empty()) html += legend(drawing.legend);
  return html + svg_open(drawing.width, drawing.height, drawing.caption) + drawing.body + "</svg></figure>";
}

std::string svg_document(const Drawing& drawing) {
  const double legend_height = kLegendRow * static_cast<double>(drawing.legend.size());
  const double height = kHeader + drawing.height + legend_height + kMargin;
  const std::string size = coordinate(drawing.width) + " " + coordinate(height);
  const std::string caption = drawing.caption + (drawing.unit.empty() ? "" : " [" + drawing.unit + "]");
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size +
         "\" width=\"" + coordinate(drawing.width) + "\" height=\"" + coordinate(height) + "\"><style><![CDATA[" +
         kPageStyle +
         "svg{font-family:system-ui,sans-serif}]]></style><rect style=\"--hue:var(--card)\" width=\"100%\" "
         "height=\"100%\"/>" +
         svg_text(kMargin, 22.0, "start", caption) + "<g transform=\"translate(0 " + coordinate(kHeader) + ")\">" +
         drawing.body + "</g>" + legend_rows(drawing, kHeader + drawing.height + 14.0) + "</svg>\n";
}

}  // namespace plumbline
