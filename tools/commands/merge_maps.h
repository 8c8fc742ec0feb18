#pragma once

#include <string>
#include <vector>

namespace plumbline {

struct MergeMapsArguments {
  std::string a;
  std::string b;
  std::string out;
  std::vector<double> start;  ///< x, y, z [m] and yaw [deg] of B's origin in A; empty: all zero
};

/// Aligns B with A, says how well they go together, and writes both in A's frame with a picture beside it; writes
/// nothing if they do not. @returns the program's exit code
int merge_maps(const MergeMapsArguments& arguments);

}  // namespace plumbline
