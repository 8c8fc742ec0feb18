#pragma once

#include <string>
#include <vector>

namespace plumbline {

struct SweepArguments {
  std::string sweep;
  std::string out;
  int jobs = 0;       ///< runs at a time; 0: as many as the machine has cores. With Slurm, tasks of the array
  std::string shard;  ///< "I/N"; empty: all
  bool resume = false;
  std::string launcher = "local";  ///< or "slurm"
  std::string shrink;              ///< key of a failing run to reduce, in place of sweeping
};

/// Makes the runs of a sweep file, or goes on with them, and writes its tables and report. @returns the exit code
int run_sweep(const SweepArguments& arguments);

}  // namespace plumbline
