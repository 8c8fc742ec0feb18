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
#include "tools/study/sweep_outputs.h"
#include "tools/study/sweep_runner.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

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

int sweep_into(const fs::path& out, const SweepPlan& plan, const RunCommand& command, const SweepArguments& arguments) {
  const auto mode = arguments.resume ? SweepDirectory::Mode::kResume : SweepDirectory::Mode::kNew;
  SweepOptions options{jobs_or_cores(arguments.jobs), shard_of(arguments.shard), {}};
  SweepDirectory directory(out, plan, mode);
  catch_interrupts();
  bool completed = false;
  {
    ProgressLine line(plan.name);
    options.progress = [&line](double share) { line.update(share); };
    completed = make_runs(plan, directory, command, options);
  }
  const std::vector<RunRow> rows = directory.rows();
  write_sweep_outputs(out, plan, rows);
  print_summary(plan, rows, out);
  if (completed) return kExitDone;
  std::cerr << "plumbline: interrupted; what has finished is kept, the same command with --resume goes on" << std::endl;
  return kExitInterrupted;
}

}  // namespace

int run_sweep(const SweepArguments& arguments) {
  const fs::path out = absolute_directory(arguments.out);
  SweepFile sweep = read_sweep_file(fs::absolute(arguments.sweep));
  // Files named by values of the sweep are relative to it, for us and for the runs, which inherit this.
  fs::current_path(sweep.path.parent_path());
  const SweepPlan plan = make_plan(sweep);
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  if (!arguments.shrink.empty()) {
    catch_interrupts();
    return shrink_run(sweep, plan, arguments.shrink, out, jobs_or_cores(arguments.jobs), program);
  }
  return sweep_into(out, plan, plumbline_run(sweep, plan, program), arguments);
}

void add_sweep_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* sweep = app.add_subcommand("sweep", "Run a scenario over ranges of its keys, seeds and estimators");
  sweep->add_option("SWEEP", arguments->sweep, "sweep file")->required();
  sweep->add_option("--out", arguments->out, "directory for the results")->required();
  add_jobs_option(*sweep, arguments->jobs);
  sweep->add_option("--shard", arguments->shard, "I/N: only the I-th of N shares of the work, I from 1; see merge");
  sweep->add_flag("--resume", arguments->resume, "go on with what is in the directory");
  sweep->add_option("--shrink", arguments->shrink,
                    "RUN: reduce a failing run to the simplest scenario that still fails, as DIR/shrunk/RUN.yaml");
  sweep->callback([arguments, &chosen] { chosen = [arguments] { return run_sweep(*arguments); }; });
}

}  // namespace plumbline
