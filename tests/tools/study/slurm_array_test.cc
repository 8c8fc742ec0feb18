#include "tools/study/slurm_array.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(SlurmArray, NeighbouringIndicesAreRanges) {
  EXPECT_EQ(index_ranges({1}), "1");
  EXPECT_EQ(index_ranges({1, 2, 3, 7, 9, 10}), "1-3,7,9-10");
  EXPECT_EQ(index_ranges({}), "");
}

}  // namespace
}  // namespace plumbline
