#pragma once

#include <string>

namespace plumbline {

struct CalibrateArguments {
  std::string sweep;
  std::string out;  ///< the file; the sweep's own directory stands beside it, as OUT.sweep
  int jobs = 0;     ///< 0: as many as the machine has cores
};

/// Makes the runs of a sweep, or goes on with them, and writes the thresholds that tell degenerate solves from
/// well-determined ones best. @returns the exit code
int run_calibrate(const CalibrateArguments& arguments);

}  // namespace plumbline
