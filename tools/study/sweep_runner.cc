#include "tools/study/sweep_runner.h"

#include <set>

#include "tools/study/boundary_curves.h"
#include "tools/study/run_children.h"
#include "tools/study/run_outcome.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// Starts runs of a sweep and stores what becomes of them.
class RunMaker {
 public:
  RunMaker(const SweepPlan& plan, SweepDirectory& directory, const RunCommand& command, const SweepOptions& options)
      : plan_(plan), directory_(directory), command_(command), options_(options) {}

  /// @param expected  runs to be made in all, for the progress
  bool make(const std::vector<std::string>& keys, std::size_t expected) {
    std::vector<ChildTask> tasks;
    for (const std::string& key : keys) {
      tasks.push_back({key, command_(*plan_.find(key), directory_.paths().run(key))});
    }
    return run_children(
               tasks, options_.jobs, plan_.limits, [&](const ChildTask& task) { start(task.key); },
               [&](const ChildTask& task, const ChildEnd& end) { finish(task.key, end, expected); }) &&
           !interrupted_;
  }

 private:
  /// What an earlier attempt left there must not be taken for this one's result.
  void start(const std::string& key) const { fs::remove_all(directory_.paths().run(key)); }

  void finish(const std::string& key, const ChildEnd& end, std::size_t expected) {
    const fs::path run_directory = directory_.paths().run(key);
    const auto outcome = outcome_of(*plan_.find(key), end, plan_.limits, run_directory);
    if (!outcome) {
      fs::remove_all(run_directory);
      interrupted_ = true;
      return;
    }
    directory_.store().add(*outcome);
    ++made_;
    if (options_.progress && expected > 0) {
      options_.progress(static_cast<double>(made_) / static_cast<double>(expected));
    }
  }

  const SweepPlan& plan_;
  SweepDirectory& directory_;
  const RunCommand& command_;
  const SweepOptions& options_;
  std::size_t made_ = 0;
  bool interrupted_ = false;
};

/// How many runs the boundary searches of a share may still ask for.
std::size_t budget_left(const SweepPlan& plan, const std::vector<RunRow>& rows, const Shard& shard) {
  const std::vector<BoundaryCurve> all = boundary_curves(plan);
  std::size_t left = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!shard.holds(i)) continue;
    const BoundarySearch search = replay(all[i], rows).search;
    left += search.budget() - search.made();
  }
  return left;
}

}  // namespace

RunCommand plumbline_run(const SweepFile& sweep, const SweepPlan& plan, const std::string& program) {
  return [scenario = fs::absolute(sweep.scenario).string(), &plan, program](const PlannedRun& run,
                                                                            const fs::path& directory) {
    std::vector<std::string> command{program,           "run",         scenario,    "--seed", std::to_string(run.seed),
                                     "--estimator",     run.estimator, "--threads", "1",      "--out",
                                     directory.string()};
    for (const std::string& override : overrides_of(plan, run)) {
      command.emplace_back("--set");
      command.push_back(override);
    }
    if (!plan.detectors.empty()) command.emplace_back("--detectors");
    return command;
  };
}

std::vector<std::string> share_of_runs(const SweepPlan& plan, const Shard& shard) {
  std::vector<std::string> keys;
  if (!plan.boundary()) {
    for (std::size_t i = 0; i < plan.runs.size(); ++i) {
      if (shard.holds(i)) keys.push_back(plan.runs[i].key);
    }
    return keys;
  }
  const std::vector<BoundaryCurve> all = boundary_curves(plan);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!shard.holds(i)) continue;
    for (const auto& seeds : all[i].keys) keys.insert(keys.end(), seeds.begin(), seeds.end());
  }
  return keys;
}

std::vector<std::string> runs_to_make(const SweepPlan& plan, const std::vector<RunRow>& rows, const Shard& shard) {
  std::vector<std::string> keys;
  if (plan.boundary()) {
    const std::vector<BoundaryCurve> all = boundary_curves(plan);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!shard.holds(i)) continue;
      const ReplayedSearch replayed = replay(all[i], rows);
      keys.insert(keys.end(), replayed.next.begin(), replayed.next.end());
    }
    return keys;
  }
  std::set<std::string> known;
  for (const RunRow& row : rows) known.insert(row.run.key);
  for (const std::string& key : share_of_runs(plan, shard)) {
    if (!known.contains(key)) keys.push_back(key);
  }
  return keys;
}

bool make_runs(const SweepPlan& plan, SweepDirectory& directory, const RunCommand& command,
               const SweepOptions& options) {
  RunMaker maker(plan, directory, command, options);
  const std::size_t searched = plan.boundary() ? budget_left(plan, directory.rows(), options.shard) : 0;
  for (;;) {
    const std::vector<std::string> batch = runs_to_make(plan, directory.rows(), options.shard);
    if (batch.empty()) return true;
    if (!maker.make(batch, plan.boundary() ? searched : batch.size())) return false;
  }
}

}  // namespace plumbline
