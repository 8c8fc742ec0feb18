#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/study/sweep_directory.h"

namespace plumbline {

/// A share of a sweep's work: every `count`-th run (or boundary curve), from the `index`-th on.
struct Shard {
  std::size_t index = 1;  ///< 1 ... count
  std::size_t count = 1;

  bool holds(std::size_t place) const { return place % count == index - 1; }
};

/// How a run becomes a process: its program and arguments, to write into that directory.
using RunCommand = std::function<std::vector<std::string>(const PlannedRun&, const std::filesystem::path& directory)>;

struct SweepOptions {
  int jobs = 1;
  Shard shard;
  std::function<void(double share)> progress;  ///< of what was left to do, [0, 1]
};

/// `plumbline run` of one run, on one thread.
RunCommand plumbline_run(const SweepFile& sweep, const SweepPlan& plan, const std::string& program);

/// Keys of the runs that belong to a share of the work, whether or not its boundary searches will ask for them.
std::vector<std::string> share_of_runs(const SweepPlan& plan, const Shard& shard);

/// Of a share, the runs that are to be made next, given what has been made: with a boundary to find one batch of every
/// search that goes on, otherwise all that are missing. Empty when the share is done.
std::vector<std::string> runs_to_make(const SweepPlan& plan, const std::vector<RunRow>& rows, const Shard& shard);

/// Makes the runs that are not stored yet and stores each as it ends. With a boundary to find, those that its searches
/// ask for.
/// @returns whether it came to its end; if not, it was interrupted
/// @throws InputError if results cannot be written; what is stored stays
bool make_runs(const SweepPlan& plan, SweepDirectory& directory, const RunCommand& command,
               const SweepOptions& options);

}  // namespace plumbline
