#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// A small plotting helper: SVG as text, coloured through the page's CSS classes so that it follows light and dark.
namespace plumbline {

/// One line. A value that is not finite breaks it.
struct ChartSeries {
  std::string label;
  std::string css_class;  ///< of the page's palette: c0 … c3, truth, estimate, warn
  std::vector<double> x;
  std::vector<double> y;
};

struct ChartRange {
  double min = 0.0;
  double max = 1.0;
};

struct LineChart {
  std::string caption;
  std::string unit;  ///< of y, written after the caption
  ChartRange x;      ///< the same for all charts that stand above each other
  std::string x_label = "time [s]";
  bool logarithmic = false;  ///< values that are not positive break the line
  double height = 200.0;     ///< of 560 wide
  std::vector<ChartSeries> series;
};

/// A figure with caption, legend and plot.
std::string line_chart(const LineChart& chart);

/// What held from one time to another.
struct StripSpan {
  double from = 0.0;
  double to = 0.0;
  std::string css_class;
};
struct StripRow {
  std::string label;
  std::vector<StripSpan> spans;
};

/// Rows of coloured bars over the same x axis as a line chart.
std::string strip_chart(const ChartRange& x, const std::vector<StripRow>& rows);

/// A horizontal bar with a mark further out: a mean with its 95th percentile.
struct Bar {
  std::string label;
  double value = 0.0;
  double mark = 0.0;
  std::string text;  ///< beside it
};
std::string bar_chart(const std::vector<Bar>& bars);

/// A legend of (class, label) pairs.
std::string legend(const std::vector<std::pair<std::string, std::string>>& entries);

/// Round positions for axis marks within a range, about so many.
std::vector<double> axis_ticks(const ChartRange& range, int about);

/// At most max_points points that keep every bucket's smallest and largest value, and its breaks.
ChartSeries thinned(const ChartSeries& series, std::size_t max_points);

}  // namespace plumbline
