#include "tools/study/boundary_search.h"

#include <algorithm>
#include <optional>

namespace plumbline {
namespace {

// Enough to keep a few cores busy, few enough that each is still chosen with knowledge of those before. Not the number
// of jobs: with another one, other runs would be made.
constexpr std::size_t kBatch = 4;
constexpr double kSurelyOutside = 0.02;

double smallest_step(const std::vector<double>& positions) {
  double step = 1.0;
  for (std::size_t i = 1; i < positions.size(); ++i) step = std::min(step, positions[i] - positions[i - 1]);
  return step;
}

}  // namespace

BoundarySearch::BoundarySearch(std::vector<double> positions, std::size_t seeds)
    : curve_(positions),
      used_(positions.size(), 0),
      seeds_(seeds),
      step_(smallest_step(positions)),
      budget_(positions.size() * seeds / 3) {}

bool BoundarySearch::has_ended() const {
  if (made_ >= budget_) return true;
  const BoundaryEstimate estimate = curve_.boundary();
  return estimate.high - estimate.low <= step_ || estimate.probability_inside < kSurelyOutside;
}

std::vector<Probe> BoundarySearch::next_batch() const {
  std::vector<Probe> batch;
  if (has_ended()) return batch;
  SuccessCurve expected = curve_;
  std::vector<std::size_t> used = used_;
  while (batch.size() < kBatch && made_ + batch.size() < budget_) {
    std::optional<std::size_t> best;
    const std::vector<double> information = expected.information();
    for (std::size_t position = 0; position < used.size(); ++position) {
      if (used[position] >= seeds_) continue;
      if (!best || information[position] > information[*best]) best = position;
    }
    if (!best) break;
    batch.push_back({*best, used[*best]++});
    expected.suppose(*best);
  }
  return batch;
}

void BoundarySearch::add(const Probe& probe, bool success) {
  curve_.add(probe.position, success);
  ++used_[probe.position];
  ++made_;
}

}  // namespace plumbline
