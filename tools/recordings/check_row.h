#pragma once

#include <optional>
#include <string>
#include <vector>

namespace plumbline {

/// One thing that a recording shows of the estimator.
struct CheckRow {
  std::string recording;
  std::string check;
  std::string bound;
  std::string measured;
  std::optional<bool> holds;  ///< empty: told, not judged
};

using CheckRows = std::vector<CheckRow>;

}  // namespace plumbline
