#pragma once

#include <string>
#include <vector>

#include "tools/report/drawing.h"
#include "tools/study/statistics.h"

namespace plumbline {

/// Values with intervals over settings of something.
struct PointChart {
  struct Point {
    double x = 0.0;
    Interval y;
  };
  struct Series {
    std::string label;
    std::string css_class;
    std::vector<Point> points;  ///< by x
  };
  struct Tick {
    double x = 0.0;
    std::string label;
  };
  enum class Style {
    kWhiskers,  ///< a dot and its interval at each setting
    kBand       ///< a line in the band of its intervals
  };

  std::string name;
  std::string caption;
  std::string unit;
  std::string x_label;
  std::vector<Tick> ticks;  ///< ascending; their ends are the axis's
  bool joined = true;       ///< dots by a line: settings that are numbers
  bool percent = false;     ///< y from 0 to 1, shown as 0 ... 100
  bool from_zero = true;    ///< otherwise y's axis fits the values
  Style style = Style::kWhiskers;
  std::vector<Series> series;
};

Drawing point_chart(const PointChart& chart);

}  // namespace plumbline
