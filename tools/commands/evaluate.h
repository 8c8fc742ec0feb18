#pragma once

#include <optional>
#include <string>

#include "tools/evaluation/alignment.h"

namespace plumbline {

struct EvaluateArguments {
  std::string ground_truth;
  std::string estimate;
  std::optional<AlignmentKind>
      alignment;     ///< of all errors; otherwise drift's first second, and se3 for the absolute error
  std::string json;  ///< empty: none is written
};

/// Compares two trajectory files and prints the figures. @returns the program's exit code
int evaluate_files(const EvaluateArguments& arguments);

}  // namespace plumbline
