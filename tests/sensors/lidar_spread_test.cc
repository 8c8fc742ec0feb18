#include "tools/verify/lidar_spread_check.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(LidarSpread, OnFlatPatchesIsThatOfRealDevicesWithinAFactorOfOneAndAHalf) {
  for (const SpreadCheck& check : check_lidar_spread()) {
    SCOPED_TRACE(check.device + " to " + std::to_string(check.greatest_range_m) + " m");
    ASSERT_GT(check.patches, 30U);
    EXPECT_GT(check.sigma_m, check.real_sigma_m / 1.5);
    EXPECT_LT(check.sigma_m, check.real_sigma_m * 1.5);
  }
}

}  // namespace
}  // namespace plumbline
