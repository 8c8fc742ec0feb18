#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "tools/study/sweep_directory.h"

namespace plumbline {

struct SlurmOptions {
  std::filesystem::path sweep;  ///< the file, absolute
  std::string program;          ///< that every node finds at this place
  std::size_t tasks = 1;        ///< of the array, at most
  std::function<void(double share)> progress;
};

/// Makes the runs that are not stored yet as a Slurm job array: each task makes a shard of the sweep in a directory of
/// its own, slurm/I below the sweep's (which all nodes must see), and at the end the shards are merged. What is killed
/// at any moment goes on: a job that is still there is waited for, not submitted again.
///
/// An interrupt cancels the job and keeps what has finished.
/// @returns empty if all runs are there, otherwise what is amiss
/// @throws InputError if Slurm is not there or refuses, or results cannot be written
std::string make_runs_by_slurm(const SweepPlan& plan, SweepDirectory& directory, const SlurmOptions& options);

}  // namespace plumbline
