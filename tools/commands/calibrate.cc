#include "tools/commands/calibrate.h"

#include <iostream>
#include <memory>

#include "estimator/solver/detectors.h"
#include "scenarios/input_error.h"
#include "tools/commands/command.h"
#include "tools/commands/study_options.h"
#include "tools/exit_code.h"
#include "tools/formats/number_text.h"
#include "tools/interrupt.h"
#include "tools/lab/threshold_calibration.h"
#include "tools/output/atomic_file.h"
#include "tools/progress_line.h"
#include "tools/study/sweep_outputs.h"
#include "tools/study/sweep_runner.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

ModuleThreshold threshold_of(const std::string& module, const SweepPlan& plan, const SweepPaths& paths) {
  std::vector<LabelledSolve> solves;
  for (const PlannedRun& run : plan.runs) {
    const auto of_run = labelled_solves(paths.run(run.key), module);
    solves.insert(solves.end(), of_run.begin(), of_run.end());
  }
  return calibrate_threshold(module, solves);
}

void print(const ModuleThreshold& found) {
  std::cout << "  " << found.module << "  ";
  if (!found.threshold) {
    std::cout << "no solves of both kinds (" << found.degenerate << " degenerate, " << found.well << " well)\n";
    return;
  }
  std::cout << readable_text(*found.threshold) << "  (degenerate to " << readable_text(*found.degenerate_to)
            << ", well determined from " << readable_text(*found.well_from)
            << (found.is_clear() ? ")\n" : "): they overlap\n");
}

}  // namespace

int run_calibrate(const CalibrateArguments& arguments) {
  const fs::path file = absolute_directory(arguments.out);
  if (fs::is_directory(file)) throw InputError("--out " + file.string() + ": is a directory, expected a file to write");
  SweepFile sweep = read_sweep_file(fs::absolute(arguments.sweep));
  // The labels come with the detectors.
  if (sweep.detectors.empty()) sweep.detectors = {std::string(to_string(Detector::kD))};
  fs::current_path(sweep.path.parent_path());
  const SweepPlan plan = make_plan(sweep);
  SweepDirectory directory(file.string() + ".sweep", plan, SweepDirectory::Mode::kResume);
  catch_interrupts();
  bool completed = false;
  {
    ProgressLine line(plan.name);
    const SweepOptions options{jobs_or_all(arguments.jobs), {}, [&line](double share) { line.update(share); }};
    const std::string program = own_program();
    completed = make_runs(plan, directory, plumbline_run(sweep, plan, program), options);
  }
  write_sweep_outputs(directory.paths().root, plan, directory.rows());
  if (!completed) {
    std::cerr << "plumbline: interrupted; what has finished is kept, the same command goes on" << std::endl;
    return kExitInterrupted;
  }
  const std::vector<ModuleThreshold> thresholds = {threshold_of("vision", plan, directory.paths()),
                                                   threshold_of("lidar", plan, directory.paths())};
  write_file_atomically(file, thresholds_yaml(plan.name, thresholds));
  std::cout << plan.name << ": thresholds on the eigenvalues of whitened J^T J\n";
  for (const ModuleThreshold& one : thresholds) print(one);
  std::cout << "  file  " << file.string() << std::endl;
  return kExitDone;
}

void add_calibrate_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* calibrate =
      app.add_subcommand("calibrate", "Find each module's threshold of degeneracy from a sweep's true labels");
  calibrate->add_option("SWEEP", arguments->sweep, "sweep file over degenerate and ordinary places")->required();
  calibrate->add_option("--out", arguments->out, "file for the thresholds; the runs go to OUT.sweep")->required();
  add_jobs_option(*calibrate, arguments->jobs);
  calibrate->callback([arguments, &chosen] { chosen = [arguments] { return run_calibrate(*arguments); }; });
}

}  // namespace plumbline
