#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/random_stream.h"
#include "tools/study/comparison.h"

/// Regressions played many times over with runs drawn from banks.
namespace plumbline {

/// How often a gate failed.
struct FailureCount {
  std::size_t failed = 0;
  std::size_t of = 0;
  std::size_t by_main_figure = 0;  ///< 1 s relative error over the whole suite among them

  double rate() const { return of == 0 ? 0.0 : static_cast<double>(failed) / static_cast<double>(of); }
};

/// The same program against itself: each time twice `seeds` different seeds of every scenario are drawn from the bank,
/// half of them on either side, paired as they come. Harder than what happens in use, where a pair shares its seed.
FailureCount against_itself(const std::vector<MeasuredRun>& bank, std::size_t seeds, std::size_t times);

/// Two programs: each time `seeds` seeds of every scenario are drawn, the same on both sides.
FailureCount against_each_other(const std::vector<MeasuredRun>& before, const std::vector<MeasuredRun>& after,
                                std::size_t seeds, std::size_t times);

/// The rate that so few failures or fewer would have happened at with a probability of 5 % only (Clopper and Pearson).
double upper_bound_95(const FailureCount& count);
/// Likewise from below.
double lower_bound_95(const FailureCount& count);

}  // namespace plumbline
