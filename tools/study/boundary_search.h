#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/study/success_curve.h"

namespace plumbline {

/// One run of a search: which of the axis's values, and which of the seeds.
struct Probe {
  std::size_t position = 0;
  std::size_t seed = 0;
};

/// Chooses runs one batch after the other, each where it is expected to tell most about the boundary, given what the
/// runs before said. Made of at most a third of the runs of the whole grid; ends earlier once the boundary is known to
/// within a step of it, or known not to be there. What is chosen depends on nothing but the outcomes.
class BoundarySearch {
 public:
  /// @param positions  of the axis's values, in [0, 1], ascending
  /// @param seeds  how many runs each value can have
  BoundarySearch(std::vector<double> positions, std::size_t seeds);

  /// Empty when the search has ended. All of a batch are to be answered, in its order, before the next is asked for.
  std::vector<Probe> next_batch() const;
  void add(const Probe& probe, bool success);

  std::size_t made() const { return made_; }
  std::size_t budget() const { return budget_; }
  const SuccessCurve& curve() const { return curve_; }

 private:
  bool has_ended() const;

  SuccessCurve curve_;
  std::vector<std::size_t> used_;  ///< seeds, per position
  std::size_t seeds_;
  double step_;
  std::size_t budget_;
  std::size_t made_ = 0;
};

}  // namespace plumbline
