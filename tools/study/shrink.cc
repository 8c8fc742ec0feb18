#include "tools/study/shrink.h"

#include <iostream>

#include "scenarios/scenario.h"
#include "scenarios/scenario_files.h"
#include "tools/exit_code.h"
#include "tools/interrupt.h"
#include "tools/output/atomic_file.h"
#include "tools/study/run_children.h"
#include "tools/study/run_outcome.h"
#include "tools/study/scenario_reducer.h"
#include "tools/study/sweep_directory.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// Values that name files must do so from anywhere.
void make_absolute(ConfigNode& keys) {
  for (const auto& [section, key] : {std::pair{"world", "mjcf"}, std::pair{"motion", "tum"}}) {
    const auto found = keys.entries.find(section);
    if (found == keys.entries.end()) continue;
    const auto file = found->second.entries.find(key);
    if (file == found->second.entries.end() || !file->second.is_scalar()) continue;
    file->second.text = (file->second.directory / file->second.text).lexically_normal().string();
  }
}

ConfigNode keys_of(const SweepFile& sweep, const SweepPlan& plan, const PlannedRun& run) {
  std::vector<std::string> overrides = overrides_of(plan, run);
  overrides.push_back("estimator.name=" + run.estimator);
  overrides.push_back("seed=" + std::to_string(run.seed));
  ConfigNode keys = read_scenario_files(sweep.scenario, overrides);
  make_absolute(keys);
  return keys;
}

/// How a run failed: what has to stay the same.
struct Failure {
  std::string outcome;
  std::string status;

  bool operator==(const Failure&) const = default;
};

Failure failure_of(const SweepPlan& plan, const PlannedRun& run, const fs::path& out) {
  for (const RunRow& row : run_rows(plan, read_sweep(out).runs)) {
    if (row.run.key != run.key) continue;
    if (row.is_ok()) throw InputError("--shrink " + run.key + ": the run is ok, there is nothing to shrink");
    return {row.outcome, row.status};
  }
  throw InputError("--shrink " + run.key + ": the run has not been made in " + out.string());
}

/// Runs candidates in a directory of their own and compares their failures with the one that is sought.
class CandidateRuns {
 public:
  CandidateRuns(const SweepPlan& plan, const PlannedRun& run, Failure failure, fs::path place, int jobs,
                std::string program)
      : plan_(plan),
        run_(run),
        failure_(std::move(failure)),
        place_(std::move(place)),
        jobs_(jobs),
        program_(std::move(program)) {
    fs::remove_all(place_);
    fs::create_directories(place_);
  }
  ~CandidateRuns() {
    std::error_code ignored;
    fs::remove_all(place_, ignored);
  }
  CandidateRuns(const CandidateRuns&) = delete;
  CandidateRuns& operator=(const CandidateRuns&) = delete;

  std::vector<bool> still_fail(const std::vector<ConfigNode>& candidates) {
    std::vector<bool> fail(candidates.size(), false);
    std::vector<ChildTask> tasks;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const std::string name = std::to_string(i);
      const fs::path file = place_ / (name + ".yaml");
      write_file_atomically(file, canonical_yaml(candidates[i]));
      if (loads(file)) {
        tasks.push_back({name, {program_, "run", file.string(), "--threads", "1", "--out", (place_ / name).string()}});
      }
    }
    made_ += tasks.size();
    const bool completed = run_children(
        tasks, jobs_, plan_.limits, [&](const ChildTask& task) { fs::remove_all(place_ / task.key); },
        [&](const ChildTask& task, const ChildEnd& end) {
          const auto stored = outcome_of(run_, end, plan_.limits, place_ / task.key);
          if (!stored) return;
          const std::vector<RunRow> row = run_rows(plan_, {*stored});
          fail[std::stoul(task.key)] = Failure{row.front().outcome, row.front().status} == failure_;
        });
    if (!completed) fail.clear();
    std::cerr << "shrinking: " << made_ << " runs" << std::endl;
    return fail;
  }

  std::size_t made() const { return made_; }

 private:
  /// What is no scenario at all needs no run to be turned down.
  static bool loads(const fs::path& file) {
    try {
      load_scenario(file, {}, {});
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  const SweepPlan& plan_;
  const PlannedRun& run_;
  Failure failure_;
  fs::path place_;
  int jobs_;
  std::string program_;
  std::size_t made_ = 0;
};

}  // namespace

int shrink_run(const SweepFile& sweep, const SweepPlan& plan, const std::string& key, const fs::path& out, int jobs,
               const std::string& program) {
  const PlannedRun* run = plan.find(key);
  if (run == nullptr) {
    throw InputError("--shrink: found '" + key + "', expected a run's key, from " + plan.runs.front().key + " to " +
                     plan.runs.back().key);
  }
  const Failure failure = failure_of(plan, *run, out);
  CandidateRuns runs(plan, *run, failure, out / "shrunk" / (".work-" + key), jobs, program);
  const ConfigNode simplest =
      reduced(keys_of(sweep, plan, *run), static_cast<std::size_t>(jobs),
              [&](const std::vector<ConfigNode>& candidates) { return runs.still_fail(candidates); });
  const fs::path file = out / "shrunk" / (key + ".yaml");
  write_file_atomically(file, "# The simplest scenario that still ends as run " + key + " of " + plan.name +
                                  " does: " + (failure.outcome == "finished" ? failure.status : failure.outcome) +
                                  ".\n" + canonical_yaml(simplest));
  std::cout << key << ": reduced in " << runs.made() << " runs\n  scenario    " << file.string() << std::endl;
  return interrupted() ? kExitInterrupted : kExitDone;
}

}  // namespace plumbline
