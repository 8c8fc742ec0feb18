#include "tools/study/sweep_directory.h"

#include <set>

#include "scenarios/input_error.h"
#include "tools/study/run_outcome.h"
#include "tools/study/suite_plan.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlan = "plan";

/// The directory with room for runs, made if need be.
fs::path prepared(const fs::path& root, SweepDirectory::Mode mode) {
  std::error_code error;
  if (fs::exists(root, error) && !fs::is_directory(root, error)) {
    throw InputError("--out " + root.string() + ": exists and is not a directory");
  }
  const SweepPaths paths{root};
  const bool is_sweep = fs::exists(paths.store(), error) || fs::exists(paths.runs(), error);
  if (is_sweep && mode == SweepDirectory::Mode::kNew) {
    throw InputError("--out " + root.string() + ": holds a sweep already; --resume goes on with it");
  }
  if (!is_sweep && fs::exists(root, error)) {
    for (const auto& entry : fs::directory_iterator(root, error)) {
      if (entry.path().filename() != ".lock") {
        throw InputError("--out " + root.string() + ": the directory is not empty and holds no sweep");
      }
    }
  }
  fs::create_directories(root, error);
  if (error) throw InputError("--out " + root.string() + ": cannot be created: " + error.message());
  return root;
}

}  // namespace

SweepDirectory::SweepDirectory(const fs::path& root, const SweepPlan& plan, Mode mode)
    : paths_{prepared(root, mode)}, plan_(plan), lock_(root), store_(paths_.store()) {
  agree_on_plan(mode);
  std::error_code error;
  fs::create_directories(paths_.runs(), error);
  if (error) throw InputError(paths_.runs().string() + ": cannot be created: " + error.message());
  remove_leftovers();
  take_over_finished_runs();
}

void SweepDirectory::agree_on_plan(Mode mode) {
  const std::string asked = plan_json(plan_);
  const auto stored = store_.property(kPlan);
  if (!stored) {
    store_.set_property(kPlan, asked);
    return;
  }
  const std::string difference = plan_difference(*stored, asked);
  if (difference.empty()) return;
  if (mode != Mode::kResumeOrReplace || !is_suite_plan(plan_of_json(*stored))) {
    throw InputError("--out " + paths_.root.string() + ": holds another sweep, which differs in: " + difference);
  }
  replace_plan(asked);
}

/// In this order: killed in between, what is left over are runs that nothing refers to.
void SweepDirectory::replace_plan(const std::string& plan) {
  store_.clear();
  std::error_code error;
  fs::remove_all(paths_.runs(), error);
  if (error) throw InputError(paths_.runs().string() + ": cannot be removed: " + error.message());
  store_.set_property(kPlan, plan);
}

/// A killed run's half-written directory; nobody else writes while the lock is held.
void SweepDirectory::remove_leftovers() const {
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (const auto& entry : fs::directory_iterator(paths_.runs(), error)) {
    if (entry.path().filename().string().starts_with(".")) leftovers.push_back(entry.path());
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, error);
}

void SweepDirectory::take_over_finished_runs() {
  std::set<std::string> known;
  for (const StoredRun& run : store_.runs()) known.insert(run.key);
  for (const PlannedRun& run : plan_.runs) {
    if (known.contains(run.key)) continue;
    if (const auto found = found_outcome(run, plan_.program, paths_.run(run.key))) store_.add(*found);
  }
}

StoredSweep read_sweep(const fs::path& root) {
  const SweepPaths paths{root};
  std::error_code error;
  if (!fs::is_regular_file(paths.store(), error)) {
    throw InputError(root.string() + ": holds no sweep (looked for " + paths.store().string() + ")");
  }
  const StudyStore store(paths.store());
  const auto plan = store.property(kPlan);
  if (!plan) throw InputError(paths.store().string() + ": holds no plan");
  return {*plan, plan_of_json(*plan), store.runs()};
}

}  // namespace plumbline
