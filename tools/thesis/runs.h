#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/directory_lock.h"
#include "tools/study/run_rows.h"
#include "tools/study/study_store.h"
#include "tools/thesis/plan.h"

namespace plumbline {

/// Where the thesis suite keeps its work: thesis.sqlite, runs/KEY (each a run's own directory), streams/KEY (recorded
/// sensors, while runs are left that use them), thesis.html. One process works in it at a time.
class ThesisRuns {
 public:
  /// Makes the directory or goes on with what is in it. @throws InputError if it is in use or cannot be written to
  explicit ThesisRuns(const std::filesystem::path& root);

  std::filesystem::path run_directory(const ThesisRun& run) const { return root_ / "runs" / run.planned.key; }
  std::filesystem::path streams() const { return root_ / "streams"; }
  std::filesystem::path stream_directory(const ThesisRun& run) const { return streams() / run.stream; }
  std::filesystem::path page() const { return root_ / "thesis.html"; }

  bool has(const ThesisRun& run) const { return runs_.contains(run.planned.key); }
  /// Of each configuration, of each seed.
  std::vector<std::vector<std::optional<RunRow>>> of(const ThesisRow& row) const;
  /// Those that have not ended, seed by seed.
  std::vector<const ThesisRun*> missing(const ThesisRow& row) const;
  void add(const StoredRun& run);

  /// What one run of the row takes [s]: as long as its last one, or else as its simulated time suggests.
  double expected_s(const Experiment& experiment) const;
  void remember_cost(const Experiment& experiment, double wall_s);

 private:
  std::filesystem::path root_;
  DirectoryLock lock_;
  StudyStore store_;
  std::map<std::string, StoredRun> runs_;
};

}  // namespace plumbline
