#pragma once

#include <string>

#include "tools/report/svg_chart.h"

/// The frame that line and strip charts share.
namespace plumbline {

constexpr double kChartWidth = 560.0;
constexpr double kChartLeft = 66.0;
constexpr double kChartRight = 548.0;

/// Maps a range onto a stretch of the picture.
class ChartScale {
 public:
  ChartScale(const ChartRange& range, double from, double to)
      : min_(range.min), factor_(range.max > range.min ? (to - from) / (range.max - range.min) : 0.0), from_(from) {}
  double operator()(double value) const { return from_ + (value - min_) * factor_; }

 private:
  double min_;
  double factor_;
  double from_;
};

/// Number with one decimal: a tenth of a pixel.
std::string coordinate(double value);
std::string svg_text(double x, double y, const std::string& anchor, const std::string& text);
std::string svg_line(double x1, double y1, double x2, double y2, const std::string& css_class);
std::string svg_open(double width, double height, const std::string& description);

/// Ticks and labels of a time axis along the bottom.
std::string x_axis(const ChartRange& range, double top, double bottom, const std::string& label);

/// A tick's label, with as many decimals as its step needs.
std::string tick_text(double value, double step);

}  // namespace plumbline
