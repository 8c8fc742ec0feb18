#include "tools/study/sweep_merge.h"

#include <map>

#include "scenarios/input_error.h"
#include "tools/study/sweep_tables.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

struct Found {
  StoredRun run;
  fs::path source;
};

/// The same run made twice is the same but for its timing.
bool same_result(const SweepPlan& plan, const StoredRun& a, const StoredRun& b) {
  return table_csv(plan, run_rows(plan, {a})) == table_csv(plan, run_rows(plan, {b}));
}

void copy_run(const fs::path& from, const fs::path& to) {
  std::error_code error;
  if (!fs::exists(from, error) || fs::exists(to, error)) return;
  fs::path staging = to;
  staging.replace_filename(std::string(".copy-").append(to.filename().string()));
  fs::remove_all(staging, error);
  fs::copy(from, staging, fs::copy_options::recursive, error);
  if (!error) fs::rename(staging, to, error);
  if (error) throw InputError(to.string() + ": cannot be copied from " + from.string() + ": " + error.message());
}

std::map<std::string, Found> collect(const std::vector<fs::path>& sources, const SweepPlan& plan,
                                     const std::string& plan_text) {
  std::map<std::string, Found> found;
  for (const fs::path& source : sources) {
    const StoredSweep sweep = read_sweep(source);
    const std::string difference = plan_difference(plan_text, sweep.plan_text);
    if (!difference.empty()) {
      throw InputError(source.string() + ": another sweep than " + sources.front().string() +
                       ", which differs in: " + difference);
    }
    for (const StoredRun& run : sweep.runs) {
      const auto [place, is_new] = found.try_emplace(run.key, Found{run, source});
      if (!is_new && !same_result(plan, place->second.run, run)) {
        throw InputError(source.string() + ": run " + run.key + " has another result than in " +
                         place->second.source.string());
      }
    }
  }
  return found;
}

void bring_in(const std::map<std::string, Found>& found, SweepDirectory& directory) {
  for (const auto& [key, run] : found) {
    copy_run(SweepPaths{run.source}.run(key), directory.paths().run(key));
    directory.store().add(run.run);
  }
}

}  // namespace

void merge_into(SweepDirectory& target, const SweepPlan& plan, const std::vector<fs::path>& sources) {
  bring_in(collect(sources, plan, plan_json(plan)), target);
}

MergedSweep merge_sweeps(const std::vector<fs::path>& sources, const fs::path& target) {
  const StoredSweep first = read_sweep(sources.front());
  const std::map<std::string, Found> found = collect(sources, first.plan, first.plan_text);
  SweepDirectory directory(target, first.plan, SweepDirectory::Mode::kResume);
  bring_in(found, directory);
  return {first.plan, directory.rows()};
}

}  // namespace plumbline
