#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/directory_lock.h"
#include "tools/study/run_rows.h"
#include "tools/study/study_store.h"
#include "tools/study/sweep_plan.h"

namespace plumbline {

/// Where a sweep's files are: sweep.sqlite, runs/KEY (each a run's own directory), table.csv, table.jsonl, timing.csv,
/// boundary.csv, report.html and charts/*.svg.
struct SweepPaths {
  std::filesystem::path root;

  std::filesystem::path store() const { return root / "sweep.sqlite"; }
  std::filesystem::path runs() const { return root / "runs"; }
  std::filesystem::path run(const std::string& key) const { return runs() / key; }
};

/// A sweep's directory held for writing: locked, its store open, its plan agreed on.
class SweepDirectory {
 public:
  enum class Mode {
    kNew,
    kResume,
    kResumeOrReplace  ///< for suites: runs of another program or another suite give way
  };

  /// Makes the directory, or takes up one that holds the same sweep.
  /// @throws InputError if it holds something else (kNew: anything), another sweep's plan (kResumeOrReplace: a plan
  /// that is no suite's), or is being written to
  SweepDirectory(const std::filesystem::path& root, const SweepPlan& plan, Mode mode);

  const SweepPaths& paths() const { return paths_; }
  StudyStore& store() { return store_; }
  /// Everything stored so far, by key.
  std::vector<RunRow> rows() const { return run_rows(plan_, store_.runs()); }

 private:
  void agree_on_plan(Mode mode);
  void replace_plan(const std::string& plan);
  void remove_leftovers() const;
  void take_over_finished_runs();

  SweepPaths paths_;
  SweepPlan plan_;
  DirectoryLock lock_;
  StudyStore store_;
};

/// What a sweep's directory says of itself, for reports and merging.
struct StoredSweep {
  std::string plan_text;
  SweepPlan plan;
  std::vector<StoredRun> runs;
};
/// @throws InputError if there is no readable sweep
StoredSweep read_sweep(const std::filesystem::path& root);

}  // namespace plumbline
