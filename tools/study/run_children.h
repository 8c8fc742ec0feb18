#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/study/child_process.h"

namespace plumbline {

/// A run to be made as a process of its own.
struct ChildTask {
  std::string key;
  std::vector<std::string> command;
};

/// Runs all tasks in their order, up to `jobs` at a time.
/// @param starting  called before a task starts
/// @param ended  called as each ends, in whatever order they do; what it throws ends them all
/// @returns false if an interrupt ended it early: what was running then is killed, and `ended` never hears of it
bool run_children(const std::vector<ChildTask>& tasks, int jobs, const RunLimits& limits,
                  const std::function<void(const ChildTask&)>& starting,
                  const std::function<void(const ChildTask&, const ChildEnd&)>& ended);

}  // namespace plumbline
