#include "tools/report/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/report/markup.h"
#include "tools/report/svg_axes.h"

namespace plumbline {
namespace {

constexpr double kLeft = 96.0;
constexpr double kFirstRow = 6.0;
constexpr double kRowHeight = 34.0;
constexpr double kBelow = 48.0;
constexpr std::size_t kLongestLabel = 11;
constexpr double kLeastTextWidth = 44.0;  // of a cell, to hold its figure

using Colour = std::array<double, 3>;
// Luminance falls all the way, so that the order shows without seeing colours.
constexpr std::array<Colour, 5> kRamp = {
    {{255, 247, 214}, {254, 204, 120}, {246, 133, 68}, {205, 42, 45}, {104, 0, 31}}};

std::string colour_text(double badness) {
  const double at = std::clamp(badness, 0.0, 1.0) * (kRamp.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kRamp.size() - 2);
  const double share = at - static_cast<double>(below);
  std::array<int, 3> channel{};
  for (std::size_t i = 0; i < 3; ++i) {
    channel[i] = static_cast<int>(std::lround((1.0 - share) * kRamp[below][i] + share * kRamp[below + 1][i]));
  }
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", channel[0], channel[1], channel[2]);
  return text;
}

std::string shortened(const std::string& label) {
  return label.size() <= kLongestLabel ? label : label.substr(0, kLongestLabel - 1) + "…";
}

std::string cell_svg(const HeatMap::Cell& cell, double x, double y, double width) {
  std::string svg = "<g><title>" + escape_markup(cell.detail) +
                    "</title><rect style=\"--hue:" + colour_text(cell.badness) + "\" x=\"" + coordinate(x + 1.0) +
                    "\" y=\"" + coordinate(y + 1.0) + "\" width=\"" + coordinate(width - 2.0) + "\" height=\"" +
                    coordinate(kRowHeight - 2.0) + "\"/>";
  if (width >= kLeastTextWidth) {
    svg += std::string("<text class=\"") + (cell.badness > 0.55 ? "on-dark" : "on-pale") + "\" x=\"" +
           coordinate(x + 0.5 * width) + "\" y=\"" + coordinate(y + 0.5 * kRowHeight + 5.0) +
           "\" text-anchor=\"middle\">" + escape_markup(cell.text) + "</text>";
  }
  return svg + "</g>";
}

std::string column_labels(const HeatMap& map, double width, double bottom) {
  std::string svg;
  // As many as fit.
  const auto every = static_cast<std::size_t>(std::ceil(52.0 / width));
  for (std::size_t c = 0; c < map.columns.size(); c += every) {
    svg += svg_text(kLeft + (static_cast<double>(c) + 0.5) * width, bottom + 19.0, "middle", shortened(map.columns[c]));
  }
  return svg + svg_text(0.5 * (kLeft + kChartRight), bottom + 40.0, "middle", map.x_label);
}

}  // namespace

Drawing heat_map(const HeatMap& map) {
  const double width = (kChartRight - kLeft) / static_cast<double>(std::max<std::size_t>(1, map.columns.size()));
  const double bottom = kFirstRow + kRowHeight * static_cast<double>(map.rows.size());
  Drawing drawing{map.name, map.caption, map.unit, {}, kChartWidth, bottom + kBelow, {}};
  for (std::size_t r = 0; r < map.rows.size(); ++r) {
    const double y = bottom - kRowHeight * static_cast<double>(r + 1);
    drawing.body += svg_text(kLeft - 6.0, y + 0.5 * kRowHeight + 5.0, "end", shortened(map.rows[r]));
    for (std::size_t c = 0; c < map.columns.size(); ++c) {
      const double x = kLeft + width * static_cast<double>(c);
      if (map.cells[r][c]) drawing.body += cell_svg(*map.cells[r][c], x, y, width);
    }
  }
  drawing.body += column_labels(map, width, bottom);
  if (!map.y_label.empty()) {
    drawing.caption += ", by " + map.y_label + " (upwards)";
  }
  return drawing;
}

}  // namespace plumbline
