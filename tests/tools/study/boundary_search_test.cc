#include "tools/study/boundary_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr std::size_t kValues = 24;
constexpr std::size_t kSeeds = 5;

/// The made-up estimator: success falls along the axis, logistic about `place`.
struct Truth {
  double place = 0.5;
  double slope = 0.03;
  std::uint64_t seed = 1;

  bool succeeds(std::size_t position, std::size_t trial) const {
    const double u = static_cast<double>(position) / (kValues - 1);
    RandomStream draw(seed, "trial." + std::to_string(position) + "." + std::to_string(trial));
    return draw.uniform() < 1.0 / (1.0 + std::exp((u - place) / slope));
  }
};

std::vector<double> positions() {
  std::vector<double> positions;
  for (std::size_t i = 0; i < kValues; ++i) positions.push_back(static_cast<double>(i) / (kValues - 1));
  return positions;
}

BoundarySearch searched(const Truth& truth) {
  BoundarySearch search(positions(), kSeeds);
  for (auto batch = search.next_batch(); !batch.empty(); batch = search.next_batch()) {
    for (const Probe& probe : batch) search.add(probe, truth.succeeds(probe.position, probe.seed));
  }
  return search;
}

SuccessCurve whole_grid(const Truth& truth) {
  SuccessCurve curve(positions());
  for (std::size_t position = 0; position < kValues; ++position) {
    for (std::size_t trial = 0; trial < kSeeds; ++trial) curve.add(position, truth.succeeds(position, trial));
  }
  return curve;
}

double width(const BoundaryEstimate& estimate) { return estimate.high - estimate.low; }

std::vector<Truth> many_truths() {
  std::vector<Truth> truths;
  for (int i = 0; i < 20; ++i) {
    truths.push_back({0.15 + 0.035 * i, i % 2 == 0 ? 0.015 : 0.05, static_cast<std::uint64_t>(i + 1)});
  }
  return truths;
}

TEST(BoundarySearch, AThirdOfTheRunsResolvesWhatTheWholeGridDoes) {
  std::vector<double> ratios;
  for (const Truth& truth : many_truths()) {
    const BoundarySearch search = searched(truth);
    EXPECT_LE(3 * search.made(), kValues * kSeeds);
    ratios.push_back(width(search.curve().boundary()) / width(whole_grid(truth).boundary()));
  }
  std::sort(ratios.begin(), ratios.end());
  // Equal resolution: half the time at least as sharp, but for a cell of the posterior's grid; the search may also stop
  // at a step's width, which is what was asked for.
  EXPECT_LE(ratios[ratios.size() / 2], 1.15);
}

TEST(BoundarySearch, ItsIntervalHoldsTheTruthAsOftenAsItSays) {
  int held = 0;
  for (const Truth& truth : many_truths()) {
    const BoundaryEstimate estimate = searched(truth).curve().boundary();
    held += truth.place >= estimate.low - 0.005 && truth.place <= estimate.high + 0.005 ? 1 : 0;
    EXPECT_GT(estimate.probability_falling, 0.95);
  }
  // Of 20 intervals at 95 %, fewer than 17 would hold with a probability of 1.6 % only.
  EXPECT_GE(held, 17);
}

TEST(BoundarySearch, KnowsWhenThereIsNoBoundary) {
  BoundarySearch search(positions(), kSeeds);
  for (auto batch = search.next_batch(); !batch.empty(); batch = search.next_batch()) {
    for (const Probe& probe : batch) search.add(probe, true);
  }
  EXPECT_LT(search.curve().boundary().probability_inside, 0.2);
  for (const CurvePoint& point : search.curve().curve({0.1, 0.5, 0.9})) EXPECT_GT(point.mean, 0.85);
}

TEST(BoundarySearch, FindsSuccessThatRisesToo) {
  BoundarySearch search(positions(), kSeeds);
  for (auto batch = search.next_batch(); !batch.empty(); batch = search.next_batch()) {
    for (const Probe& probe : batch) search.add(probe, probe.position >= 15);
  }
  const BoundaryEstimate estimate = search.curve().boundary();
  EXPECT_LT(estimate.probability_falling, 0.05);
  // The boundary lies between values 14 and 15, of a sharp step known to about one of them.
  EXPECT_NEAR(estimate.median, 14.5 / (kValues - 1), 1.0 / (kValues - 1));
}

TEST(BoundarySearch, AsksForNoRunTwice) {
  std::vector<std::pair<std::size_t, std::size_t>> asked;
  BoundarySearch search(positions(), 2);
  for (auto batch = search.next_batch(); !batch.empty(); batch = search.next_batch()) {
    for (const Probe& probe : batch) {
      asked.emplace_back(probe.position, probe.seed);
      search.add(probe, probe.position % 2 == 0);
    }
  }
  std::sort(asked.begin(), asked.end());
  EXPECT_EQ(std::adjacent_find(asked.begin(), asked.end()), asked.end());
}

}  // namespace
}  // namespace plumbline
