#pragma once

#include <string>
#include <vector>

namespace plumbline {

/// One thing that must hold of a simulated sensor.
struct VerifyRow {
  std::string check;
  std::string bound;
  std::string measured;
  bool holds = false;
};

/// What the page says of one kind of sensor. A file per section makes one.
struct VerifySection {
  std::string title;
  std::string note;
  std::vector<VerifyRow> rows;
  std::string charts;  ///< HTML
};

}  // namespace plumbline
