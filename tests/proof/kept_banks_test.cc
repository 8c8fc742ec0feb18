// The gate's statistics on real runs: banks of scenarios/suites/ci.yaml that `tools/dev regress-proof` made once.
#include <gtest/gtest.h>

#include "tests/proof/bank_judgement.h"
#include "tests/proof/resampling.h"
#include "tools/study/baseline.h"

namespace plumbline {
namespace {

constexpr std::size_t kSuiteSeeds = 8;
constexpr std::size_t kDrawings = 60;

std::vector<MeasuredRun> kept(double strength) { return read_baseline(bank_file(PLUMBLINE_KEPT_BANKS, strength)).runs; }

FailureCount caught_of(double strength) {
  std::vector<std::vector<MeasuredRun>> banks{kept(0.0), kept(strength)};
  keep_common(banks);
  return against_each_other(banks[0], banks[1], kSuiteSeeds, kDrawings);
}

TEST(KeptBanks, TheUnchangedEstimatorHardlyEverFails) {
  const FailureCount failures = against_itself(kept(0.0), kSuiteSeeds, 150);
  // Asked for is 1 % at most. At a true rate of 0.6 % five of 150 fail or more once in 400 drawings, which are always
  // the same; at 5 %, in 87 of 100.
  EXPECT_LT(failures.failed, 5U) << failures.rate();
}

/// Of 8.4 % more error a suite of eight seeds catches three in four (744 of 1,000 drawings); by root mean squares over
/// the runs it was one in two. That is what eight seeds are good for, not what is wished for.
TEST(KeptBanks, AFewPercentMoreErrorAreCaughtMoreOftenThanNot) {
  EXPECT_GT(caught_of(0.25).rate(), 0.55);  // 0.65 of these few drawings
}

TEST(KeptBanks, AReallyWorseEstimatorIsAlwaysCaught) { EXPECT_EQ(caught_of(0.8).rate(), 1.0); }

}  // namespace
}  // namespace plumbline
