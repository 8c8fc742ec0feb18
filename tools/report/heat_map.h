#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/report/drawing.h"

namespace plumbline {

/// A table of figures as coloured cells: pale is good, dark is bad.
struct HeatMap {
  std::string name;
  std::string caption;
  std::string unit;
  std::string x_label;
  std::string y_label;
  std::vector<std::string> columns;
  std::vector<std::string> rows;  ///< from the bottom up
  struct Cell {
    double badness = 0.0;  ///< [0, 1]: its colour
    std::string text;
    std::string detail;  ///< shown when pointed at
  };
  std::vector<std::vector<std::optional<Cell>>> cells;  ///< [row][column]; without data: nothing
};

Drawing heat_map(const HeatMap& map);

}  // namespace plumbline
