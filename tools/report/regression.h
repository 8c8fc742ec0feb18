#pragma once

#include <string>
#include <vector>

#include "tools/study/baseline.h"
#include "tools/study/comparison.h"

namespace plumbline {

/// A suite's runs held against a baseline, ready to be told. To be moved, not copied: the comparison points at the
/// runs.
struct Regression {
  std::string suite;
  Baseline before;
  Baseline after;
  Comparison comparison;                 ///< of these two's runs
  std::vector<double> unpaired_percent;  ///< see detectable_unpaired_percent()
  std::vector<std::string> notes;        ///< of what was not or could not be compared
};

/// @param before, after  of the same suite; on other machines time and memory are only shown, and a note says so
Regression make_regression(Baseline before, Baseline after, const Effects& effects);

/// In words for all outputs: "1 s relative error grew by 9.8 % (7.1 … 12.6) in tunnel", of everything that fails.
std::vector<std::string> failures(const Regression& regression);
/// Likewise of everything that became better.
std::vector<std::string> improvements(const Regression& regression);

/// "6.2 % (5.0 … 7.4)"; "–" where nothing can be said.
std::string growth_text(const Change& change);
/// "9.1 %", or "none" for no growth however large.
std::string detectable_text(double percent);

}  // namespace plumbline
