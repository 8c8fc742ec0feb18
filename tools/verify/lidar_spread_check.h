#pragma once

#include <string>
#include <vector>

namespace plumbline {

/// The spread of ranges on flat patches between two distances: what a user measures, and what real devices gave.
struct SpreadCheck {
  std::string device;
  double least_range_m = 0.0;
  double greatest_range_m = 0.0;
  double real_sigma_m = 0.0;  ///< recordings: the median over small patches chosen flat; Hokuyo: its repeatability
  double sigma_m = 0.0;       ///< simulated, all effects on: the median over the patches of four rooms
  std::size_t patches = 0;
};
std::vector<SpreadCheck> check_lidar_spread();

}  // namespace plumbline
