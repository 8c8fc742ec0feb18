#include "tools/commands/regress.h"

#include <iostream>
#include <memory>

#include "scenarios/input_error.h"
#include "tools/commands/command.h"
#include "tools/commands/study_options.h"
#include "tools/exit_code.h"
#include "tools/interrupt.h"
#include "tools/output/atomic_file.h"
#include "tools/output/provenance.h"
#include "tools/progress_line.h"
#include "tools/report/regress_text.h"
#include "tools/study/regress_outputs.h"
#include "tools/study/suite_plan.h"
#include "tools/study/sweep_outputs.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// @throws InputError for a baseline of another suite
Baseline baseline_for(const SuiteFile& suite, const fs::path& path) {
  Baseline baseline = read_baseline(path);
  if (baseline.suite_digest != suite_digest(suite)) {
    throw InputError(path.string() + ": baseline of another suite (" + baseline.suite + ", digest " +
                     baseline.suite_digest + "; " + suite.path.string() + " has " + suite_digest(suite) +
                     "): scenarios, keys or seeds differ; --update makes it anew");
  }
  return baseline;
}

/// Makes the runs that are missing. @returns nothing if it was interrupted
std::optional<std::vector<StoredRun>> make_suite_runs(const SuiteFile& suite, const SweepPlan& plan,
                                                      const RegressArguments& arguments, const fs::path& out) {
  SweepDirectory directory(out, plan, SweepDirectory::Mode::kResumeOrReplace);
  catch_interrupts();
  ProgressLine line(plan.name);
  const SweepOptions options{jobs_or_all(arguments.jobs), {}, [&line](double share) { line.update(share); }};
  if (!make_runs(plan, directory, suite_run(suite, arguments.estimator, own_program()), options)) return std::nullopt;
  return directory.store().runs();
}

/// A baseline made of runs that crashed would forgive every crash to come.
int update_baseline(const fs::path& path, const Baseline& runs) {
  for (const MeasuredRun& run : runs.runs) {
    if (run.status != "error") continue;
    std::cerr << "plumbline: " << run.scenario << ", seed " << run.seed << " ended in an error (" << run.reason
              << "); the baseline stays as it was" << std::endl;
    return kExitCheckFailed;
  }
  write_file_atomically(path, baseline_json(runs));
  std::cout << runs.suite << ": " << runs.runs.size() << " runs\n  baseline    " << path.string() << std::endl;
  return kExitDone;
}

void print_summary(const Regression& regression, const fs::path& out) {
  const bool passes = regression.comparison.passes();
  std::cout << regression.suite << ": " << regression.comparison.pairs.size() << " runs against the baseline, "
            << (passes ? "no regression" : "REGRESSION") << "\n";
  for (const std::string& note : regression.notes) std::cout << "  note        " << note << "\n";
  for (const std::string& failure : failures(regression)) std::cout << "  worse       " << failure << "\n";
  for (const std::string& improvement : improvements(regression)) std::cout << "  better      " << improvement << "\n";
  for (const Change& change : regression.comparison.changes) {
    if (!change.scenario.empty()) continue;
    std::cout << "  " << change.figure->title << " " << growth_text(change) << ", detectable "
              << detectable_text(change.detectable_percent) << "\n";
  }
  std::cout << "  report      " << (out / "regress.html").string() << std::endl;
}

}  // namespace

int run_regress(const RegressArguments& given) {
  RegressArguments arguments = given;
  arguments.estimator = estimator_from_anywhere(given.estimator);
  const SuiteFile suite = read_suite_file(fs::absolute(arguments.suite));
  const fs::path out = absolute_directory(arguments.out.empty() ? "out/" + suite.name : arguments.out);
  const fs::path baseline_path = fs::absolute(arguments.baseline);
  const fs::path junit_path = arguments.junit.empty() ? fs::path() : fs::absolute(arguments.junit);
  // Files named by values of the suite are relative to it, for us and for the runs, which inherit this.
  fs::current_path(suite.path.parent_path());
  SweepPlan plan = suite_plan(suite, arguments.estimator);
  // Builds of the same version are told apart: what a changed program has not run must not be taken as done.
  plan.program = program_identity(own_program());
  // What is wrong with the baseline is said before the time for the runs is spent.
  std::optional<Baseline> before;
  if (!arguments.update) before = baseline_for(suite, baseline_path);

  const auto stored = make_suite_runs(suite, plan, arguments, out);
  if (!stored) {
    std::cerr << "plumbline: interrupted; what has finished is kept, the same command goes on" << std::endl;
    return kExitInterrupted;
  }
  write_sweep_outputs(out, plan, run_rows(plan, *stored));
  Baseline after = baseline_of(suite, plan, *stored);
  if (arguments.update) return update_baseline(baseline_path, after);

  const Regression regression = make_regression(std::move(*before), std::move(after), suite.effects);
  write_regress_outputs(out, regression);
  if (!junit_path.empty()) write_file_atomically(junit_path, regress_junit(regression));
  print_summary(regression, out);
  return regression.comparison.passes() ? kExitDone : kExitCheckFailed;
}

void add_regress_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<RegressArguments>();
  CLI::App* regress = app.add_subcommand("regress", "Run a suite and compare it, run by run, with a baseline");
  regress->add_option("SUITE", arguments->suite, "suite file")->required();
  regress->add_option("--baseline", arguments->baseline, "file to compare with")->required();
  regress->add_flag("--update", arguments->update, "make the baseline anew instead of comparing with it");
  regress->add_option("--junit", arguments->junit, "file for JUnit's XML");
  regress->add_option("--out", arguments->out, "directory for runs and pages; out/SUITE by default");
  add_jobs_option(*regress, arguments->jobs);
  regress->add_option("--estimator", arguments->estimator,
                      "instead of the scenarios'; see `plumbline list estimators`");
  regress->callback([arguments, &chosen] { chosen = [arguments] { return run_regress(*arguments); }; });
}

}  // namespace plumbline
