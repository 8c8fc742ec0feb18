#include "tools/commands/sweep.h"

#include <algorithm>
#include <charconv>
#include <iostream>
#include <memory>

#include "scenarios/input_error.h"
#include "tools/commands/command.h"
#include "tools/commands/study_options.h"
#include "tools/exit_code.h"
#include "tools/interrupt.h"
#include "tools/progress_line.h"
#include "tools/study/shrink.h"
#include "tools/study/slurm_array.h"
#include "tools/study/slurm_launcher.h"
#include "tools/study/sweep_outputs.h"
#include "tools/study/sweep_runner.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSlurmTasks = 100;  // a site's MaxArraySize is 1001 unless it says otherwise
constexpr const char* kSlurm = "slurm";

Shard shard_of(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  const char* end = text.data() + text.size();
  const auto [slash, first_error] = std::from_chars(text.data(), end, shard.index);
  const bool has_slash = first_error == std::errc() && slash != end && *slash == '/';
  const auto [stop, error] = has_slash ? std::from_chars(slash + 1, end, shard.count)
                                       : std::from_chars_result{slash, std::errc::invalid_argument};
  if (error != std::errc() || stop != end || shard.index < 1 || shard.index > shard.count) {
    throw InputError("--shard: found '" + text + "', expected I/N with I from 1 to N");
  }
  return shard;
}

void print_summary(const SweepPlan& plan, const std::vector<RunRow>& rows, const fs::path& out) {
  const auto ok = std::count_if(rows.begin(), rows.end(), [](const RunRow& row) { return row.is_ok(); });
  std::cout << plan.name << ": " << rows.size() << " of " << plan.runs.size() << " runs made, " << ok << " ok\n"
            << "  report      " << (out / "report.html").string() << "\n"
            << "  tables      " << (out / "table.csv").string() << ", table.jsonl, timing.csv" << std::endl;
}

/// How the making of runs ended: with nothing to say when they are all there.
struct LaunchEnd {
  std::string amiss;
  ExitCode code = kExitDone;
};

LaunchEnd launch(const SweepFile& sweep, const SweepPlan& plan, const std::string& program,
                 const SweepArguments& arguments, SweepDirectory& directory) {
  ProgressLine line(plan.name);
  const auto progress = [&line](double share) { line.update(share); };
  if (arguments.launcher == kSlurm) {
    const std::size_t tasks = arguments.jobs > 0 ? static_cast<std::size_t>(arguments.jobs) : kSlurmTasks;
    const std::string amiss = make_runs_by_slurm(plan, directory, {sweep.path, program, tasks, progress});
    if (amiss.empty()) return {};
    if (!interrupted()) return {amiss, kExitFault};
  } else if (make_runs(plan, directory, plumbline_run(sweep, plan, program),
                       {jobs_or_all(arguments.jobs), shard_of(arguments.shard), progress})) {
    return {};
  }
  return {"interrupted; what has finished is kept, the same command with --resume goes on", kExitInterrupted};
}

int sweep_into(const fs::path& out, const SweepFile& sweep, const SweepPlan& plan, const std::string& program,
               const SweepArguments& arguments) {
  const auto mode = arguments.resume ? SweepDirectory::Mode::kResume : SweepDirectory::Mode::kNew;
  SweepDirectory directory(out, plan, mode);
  catch_interrupts();
  const LaunchEnd end = launch(sweep, plan, program, arguments, directory);
  const std::vector<RunRow> rows = directory.rows();
  write_sweep_outputs(out, plan, rows);
  print_summary(plan, rows, out);
  if (!end.amiss.empty()) std::cerr << "plumbline: " << end.amiss << std::endl;
  return end.code;
}

/// Before anything is written.
void check(const SweepArguments& arguments) {
  shard_of(arguments.shard);
  if (arguments.launcher != kSlurm) return;
  if (!arguments.shard.empty()) throw InputError("--shard: found beside --launcher slurm, which makes its own shards");
  if (!arguments.shrink.empty()) throw InputError("--shrink: found beside --launcher slurm, allowed is local");
  require_slurm();
}

}  // namespace

int run_sweep(const SweepArguments& arguments) {
  check(arguments);
  const fs::path out = absolute_directory(arguments.out);
  SweepFile sweep = read_sweep_file(fs::absolute(arguments.sweep));
  // Files named by values of the sweep are relative to it, for us and for the runs, which inherit this.
  fs::current_path(sweep.path.parent_path());
  const SweepPlan plan = make_plan(sweep);
  const std::string program = own_program();
  if (!arguments.shrink.empty()) {
    catch_interrupts();
    return shrink_run(sweep, plan, arguments.shrink, out, jobs_or_all(arguments.jobs), program);
  }
  return sweep_into(out, sweep, plan, program, arguments);
}

void add_sweep_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* sweep = app.add_subcommand("sweep", "Run a scenario over ranges of its keys, seeds and estimators");
  sweep->add_option("SWEEP", arguments->sweep, "sweep file")->required();
  sweep->add_option("--out", arguments->out, "directory for the results")->required();
  add_jobs_option(*sweep, arguments->jobs);
  sweep->add_option("--shard", arguments->shard, "I/N: only the I-th of N shares of the work, I from 1; see merge");
  sweep->add_flag("--resume", arguments->resume, "go on with what is in the directory");
  sweep
      ->add_option(
          "--launcher", arguments->launcher,
          "local, or slurm: a job array whose tasks make a shard each (--jobs: at most so many, 100 by default)")
      ->check(CLI::IsMember({"local", kSlurm}));
  sweep->add_option("--shrink", arguments->shrink,
                    "RUN: reduce a failing run to the simplest scenario that still fails, as DIR/shrunk/RUN.yaml");
  sweep->callback([arguments, &chosen] { chosen = [arguments] { return run_sweep(*arguments); }; });
}

}  // namespace plumbline
