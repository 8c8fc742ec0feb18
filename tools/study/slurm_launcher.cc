#include "tools/study/slurm_launcher.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "tools/interrupt.h"
#include "tools/output/atomic_file.h"
#include "tools/study/boundary_curves.h"
#include "tools/study/slurm_array.h"
#include "tools/study/sweep_merge.h"
#include "tools/study/sweep_runner.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kAskEvery{2};
constexpr std::chrono::milliseconds kHeedInterruptsEvery{100};
constexpr Shard kWhole{};

/// Files of the array, in slurm/ below the sweep's directory: job (its id), task.sh, a directory per shard, I.log.
struct ArrayFiles {
  fs::path root;

  fs::path job() const { return root / "job"; }
  fs::path script() const { return root / "task.sh"; }
  fs::path shard(std::size_t index) const { return root / std::to_string(index); }
  fs::path logs() const { return root / "%a.log"; }
};

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + '\'';
}

std::string task_script(const ArrayFiles& files, const SlurmOptions& options, std::size_t count) {
  return "#!/bin/sh\nexec " + quoted(options.program) + " sweep " + quoted(options.sweep.string()) + " --out " +
         quoted(files.root.string()) + "/\"$SLURM_ARRAY_TASK_ID\" --shard \"$SLURM_ARRAY_TASK_ID/" +
         std::to_string(count) + "\" --jobs 1 --resume\n";
}

std::vector<fs::path> shards_in(const ArrayFiles& files) {
  std::vector<fs::path> shards;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(files.root, error)) {
    if (fs::exists(SweepPaths{entry.path()}.store(), error)) shards.push_back(entry.path());
  }
  std::sort(shards.begin(), shards.end());
  return shards;
}

/// Merges what the tasks made and clears their directories; logs stay.
void collect(const SweepPlan& plan, const ArrayFiles& files, SweepDirectory& directory) {
  const std::vector<fs::path> shards = shards_in(files);
  // Held in turn: a run that finished before its task could store it is taken over, and nobody still writes there.
  for (const fs::path& shard : shards) const SweepDirectory held(shard, plan, SweepDirectory::Mode::kResume);
  merge_into(directory, plan, shards);
  for (const fs::path& shard : shards) fs::remove_all(shard);
  fs::remove(files.job());
}

/// A shard's directory, which knows what has been made of its share.
void prepare_shard(const SweepPlan& plan, SweepDirectory& directory, const fs::path& root, const Shard& shard) {
  const std::vector<std::string> keys = share_of_runs(plan, shard);
  const std::set<std::string> share(keys.begin(), keys.end());
  SweepDirectory prepared(root, plan, SweepDirectory::Mode::kResume);
  for (const StoredRun& run : directory.store().runs()) {
    if (share.contains(run.key)) prepared.store().add(run);
  }
}

std::string submit_shards(const SweepPlan& plan, SweepDirectory& directory, const ArrayFiles& files,
                          const SlurmOptions& options) {
  const std::size_t pieces = plan.boundary() ? boundary_curves(plan).size() : plan.runs.size();
  const std::size_t count = std::min(pieces, options.tasks);
  const std::vector<RunRow> rows = directory.rows();
  SlurmArray array{"plumbline-" + plan.name, files.script(), {}, files.logs()};
  for (std::size_t index = 1; index <= count; ++index) {
    if (runs_to_make(plan, rows, {index, count}).empty()) continue;
    prepare_shard(plan, directory, files.shard(index), {index, count});
    array.indices.push_back(index);
  }
  write_file_atomically(files.script(), task_script(files, options, count));
  const std::string job = submit(array);
  write_file_atomically(files.job(), job + "\n");
  return job;
}

std::string job_of_earlier_launch(const ArrayFiles& files) {
  std::string job;
  std::ifstream(files.job()) >> job;
  return job;
}

std::size_t finished_runs(const ArrayFiles& files) {
  std::size_t count = 0;
  std::error_code error;
  for (const fs::path& shard : shards_in(files)) {
    for (const auto& entry : fs::directory_iterator(SweepPaths{shard}.runs(), error)) {
      if (fs::exists(entry.path() / "result.json", error)) ++count;
    }
  }
  return count;
}

/// @param expected  runs to be made
void wait_for(const std::string& job, const ArrayFiles& files, std::size_t expected, const SlurmOptions& options) {
  bool cancelled = false;
  while (is_queued(job)) {
    const auto asked = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - asked < kAskEvery) {
      if (interrupted() && !cancelled) {
        cancel(job);
        cancelled = true;
      }
      std::this_thread::sleep_for(kHeedInterruptsEvery);
    }
    const double share =
        static_cast<double>(finished_runs(files)) / static_cast<double>(std::max<std::size_t>(expected, 1));
    if (options.progress) options.progress(std::min(share, 1.0));
  }
}

}  // namespace

std::string make_runs_by_slurm(const SweepPlan& plan, SweepDirectory& directory, const SlurmOptions& options) {
  const ArrayFiles files{directory.paths().root / "slurm"};
  fs::create_directories(files.root);
  if (const std::string job = job_of_earlier_launch(files); !job.empty()) {
    wait_for(job, files, plan.runs.size(), options);
  }
  collect(plan, files, directory);
  const std::size_t missing = runs_to_make(plan, directory.rows(), kWhole).size();
  if (missing == 0) return {};
  if (interrupted()) return "interrupted";
  const std::string job = submit_shards(plan, directory, files, options);
  wait_for(job, files, missing, options);
  collect(plan, files, directory);
  if (runs_to_make(plan, directory.rows(), kWhole).empty()) return {};
  return "not all tasks of job " + job + " did their work; their logs are in " + files.root.string() +
         ", and the same command with --resume makes what is missing";
}

}  // namespace plumbline
