#include "tools/commands/mount.h"

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <set>

#include "scenarios/input_error.h"
#include "tools/commands/command.h"
#include "tools/commands/study_options.h"
#include "tools/exit_code.h"
#include "tools/interrupt.h"
#include "tools/mount/mount_report.h"
#include "tools/mount/mount_tables.h"
#include "tools/output/atomic_file.h"
#include "tools/progress_line.h"
#include "tools/study/sweep_outputs.h"
#include "tools/study/sweep_runner.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPredictions = "predictions.csv";

/// A scenario of the study as a sweep over all mountings, and what predicts them.
struct Trial {
  SweepFile sweep;
  SweepPlan plan;
  std::unique_ptr<MountPredictor> predictor;
};

std::vector<Trial> make_trials(const MountStudy& study) {
  std::vector<Trial> trials;
  for (const fs::path& scenario : study.scenarios) {
    Trial trial{study.runs, {}, nullptr};
    trial.sweep.scenario = scenario;
    trial.plan = make_plan(trial.sweep);
    trials.push_back(std::move(trial));
  }
  return trials;
}

Scenario scenario_of(const Trial& trial, const PlannedRun& run) {
  return load_scenario(trial.sweep.scenario, overrides_of(trial.plan, run), run.seed);
}

/// The runs that stand for the mountings: those of the first seed and estimator.
std::vector<const PlannedRun*> mountings_of(const SweepPlan& plan) {
  std::vector<const PlannedRun*> first;
  for (const PlannedRun& run : plan.runs) {
    if (run.seed == plan.seeds.front() && run.estimator == plan.estimators.front()) first.push_back(&run);
  }
  return first;
}

/// @returns nothing if interrupted
std::vector<Mounting> predict(const MountStudy& study, std::vector<Trial>& trials) {
  ProgressLine line(study.name + ", prediction");
  const std::size_t count = mountings_of(trials.front().plan).size();
  std::vector<std::vector<MountPrediction>> predictions(count);
  for (std::size_t t = 0; t < trials.size(); ++t) {
    const std::vector<const PlannedRun*> runs = mountings_of(trials[t].plan);
    trials[t].predictor = std::make_unique<MountPredictor>(scenario_of(trials[t], *runs.front()), study.surfaces);
    for (std::size_t m = 0; m < count; ++m) {
      if (interrupted()) return {};
      predictions[m].push_back(trials[t].predictor->predict(scenario_of(trials[t], *runs[m]).rig));
      line.update(static_cast<double>(t * count + m + 1) / static_cast<double>(trials.size() * count));
    }
  }
  std::vector<Mounting> mountings;
  for (std::size_t m = 0; m < count; ++m) {
    Mounting mounting;
    mounting.values = mountings_of(trials.front().plan)[m]->values;
    mounting.predicted = combined(predictions[m]);
    mounting.ruled_out = broken_limit(mounting.predicted, study.limits);
    mountings.push_back(std::move(mounting));
  }
  return mountings;
}

/// Leaves only the runs of some mountings in the plan.
void keep_only(const std::vector<std::size_t>& chosen, SweepPlan& plan) {
  const std::size_t runs_each = plan.seeds.size() * plan.estimators.size();
  std::vector<PlannedRun> kept;
  for (const std::size_t mounting : chosen) {
    for (std::size_t i = 0; i < runs_each; ++i) kept.push_back(std::move(plan.runs[mounting * runs_each + i]));
  }
  plan.runs = std::move(kept);
}

/// Makes the directory, or takes up one that holds the same study.
void prepare(const fs::path& out, bool resume) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error || !fs::is_directory(out)) throw InputError("--out " + out.string() + ": cannot be created");
  const bool is_study = fs::exists(out / kPredictions, error);
  if (is_study && !resume)
    throw InputError("--out " + out.string() + ": holds a study already; --resume goes on with it");
  if (is_study) return;
  for (const auto& entry : fs::directory_iterator(out)) {
    if (entry.path().filename() != ".lock") {
      throw InputError("--out " + out.string() + ": the directory is not empty and holds no study");
    }
  }
}

void agree_on_predictions(const fs::path& out, const std::string& predictions) {
  const fs::path file = out / kPredictions;
  std::error_code error;
  if (!fs::exists(file, error)) return write_file_atomically(file, predictions);
  std::ifstream stream(file, std::ios::binary);
  if (std::string(std::istreambuf_iterator<char>(stream), {}) != predictions) {
    throw InputError("--out " + out.string() + ": holds another study, whose predictions differ");
  }
}

void write_outputs(const fs::path& out, const MountStudy& study, const MountResults& results,
                   std::vector<Trial>& trials) {
  std::vector<MountView> views;
  if (results.recommended) {
    for (Trial& trial : trials) {
      const std::vector<AxisValue>& values = results.mountings[*results.recommended].values;
      const auto run = std::find_if(trial.plan.runs.begin(), trial.plan.runs.end(), [&](const PlannedRun& candidate) {
        return std::equal(values.begin(), values.end(), candidate.values.begin(),
                          [](const AxisValue& a, const AxisValue& b) { return a.text == b.text; });
      });
      if (run != trial.plan.runs.end()) views.push_back(trial.predictor->view(scenario_of(trial, *run).rig));
    }
  }
  const MountReport report = mount_report(study, results, views);
  std::error_code error;
  fs::create_directories(out / "charts", error);
  for (const Drawing& chart : report.charts) {
    write_file_atomically(out / "charts" / (chart.name + ".svg"), svg_document(chart));
  }
  write_file_atomically(out / "mountings.csv", mountings_csv(study, results));
  write_file_atomically(out / "report.html", report.html);
}

}  // namespace

int run_mount(const MountArguments& arguments) {
  const fs::path out = absolute_directory(arguments.out);
  const MountStudy study = read_mount_study(fs::absolute(arguments.study));
  fs::current_path(study.path.parent_path());
  std::vector<Trial> trials = make_trials(study);
  prepare(out, arguments.resume);
  const DirectoryLock lock(out);
  catch_interrupts();
  std::vector<Mounting> mountings = predict(study, trials);
  if (interrupted()) return kExitInterrupted;
  const std::vector<std::size_t> chosen = choose_for_trial(study, mountings);
  agree_on_predictions(out, predictions_csv(study, mountings));
  if (chosen.empty()) throw InputError(study.path.string() + ": no mounting is within the limits; see predictions.csv");

  const std::string program = own_program();
  std::vector<std::vector<RunRow>> rows;
  bool completed = true;
  for (Trial& trial : trials) {
    keep_only(chosen, trial.plan);
    const fs::path directory_path = out / "runs" / trial.sweep.scenario.stem();
    SweepDirectory directory(directory_path, trial.plan, SweepDirectory::Mode::kResume);
    if (completed) {
      ProgressLine line(study.name + ", " + trial.plan.scenario);
      SweepOptions options{jobs_or_all(arguments.jobs), {}, [&line](double share) { line.update(share); }};
      completed = make_runs(trial.plan, directory, plumbline_run(trial.sweep, trial.plan, program), options);
    }
    rows.push_back(directory.rows());
    write_sweep_outputs(directory_path, trial.plan, rows.back());
  }
  const MountResults results = conclude(study, std::move(mountings), rows);
  write_outputs(out, study, results, trials);
  std::cout << study.name << ": " << results.mountings.size() << " mountings predicted, " << chosen.size()
            << " to be tried\n  " << reason_for(study, results) << "\n  report      " << (out / "report.html").string()
            << "\n  tables      " << (out / "mountings.csv").string() << ", " << kPredictions << std::endl;
  if (completed) return kExitDone;
  std::cerr << "plumbline: interrupted; what has finished is kept, the same command with --resume goes on" << std::endl;
  return kExitInterrupted;
}

void add_mount_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<MountArguments>();
  CLI::App* mount = app.add_subcommand("mount", "Find the angles and offsets at which to mount lidar and camera");
  mount->add_option("STUDY", arguments->study, "study file")->required();
  mount->add_option("--out", arguments->out, "directory for the results")->required();
  add_jobs_option(*mount, arguments->jobs);
  mount->add_flag("--resume", arguments->resume, "go on with what is in the directory");
  mount->callback([arguments, &chosen] { chosen = [arguments] { return run_mount(*arguments); }; });
}

}  // namespace plumbline
