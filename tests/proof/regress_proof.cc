// What the regression gate is worth: how often it fails an unchanged estimator, and how often it catches one that was
// really made worse, measured on a bank of runs that is made once and kept. It can be stopped and started again.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <numeric>

#include "scenarios/input_error.h"
#include "tests/proof/bank_judgement.h"
#include "tests/proof/degraded_run.h"
#include "tools/exit_code.h"
#include "tools/formats/number_text.h"
#include "tools/interrupt.h"
#include "tools/output/atomic_file.h"
#include "tools/progress_line.h"
#include "tools/study/baseline.h"
#include "tools/study/suite_plan.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

struct ProofArguments {
  std::string suite = PLUMBLINE_SCENARIO_DIR "/suites/ci.yaml";
  std::string out = "out/regress-proof";
  int bank_seeds = 64;
  int degraded_seeds = 64;
  int jobs = 1;
  int comparisons = 4000;
  bool judge_only = false;
  std::vector<double> strengths;  ///< of degradation; each has a bank of its own, made from the same simulations
};

/// A bank's runs: those of one strength.
struct DegradedBank {
  double strength = 0.0;
  fs::path root;
  SweepPlan plan;
};

/// Of the seeds 1 to `seeds`, one after the other, so that a bank that was stopped holds all scenarios.
SweepPlan plan_of(SuiteFile suite, int seeds) {
  suite.seeds.resize(static_cast<std::size_t>(seeds));
  std::iota(suite.seeds.begin(), suite.seeds.end(), std::uint64_t{1});
  SweepPlan plan = suite_plan(suite, {});
  std::vector<std::string> keys;
  for (const PlannedRun& run : plan.runs) keys.push_back(run.key);
  std::stable_sort(plan.runs.begin(), plan.runs.end(),
                   [](const PlannedRun& a, const PlannedRun& b) { return a.seed < b.seed; });
  for (std::size_t i = 0; i < keys.size(); ++i) plan.runs[i].key = keys[i];
  return plan;
}

const PlannedRun* same_run(const SweepPlan& plan, const PlannedRun& run) {
  const auto found = std::find_if(plan.runs.begin(), plan.runs.end(), [&](const PlannedRun& other) {
    return other.scenario_digest == run.scenario_digest && other.seed == run.seed;
  });
  return found == plan.runs.end() ? nullptr : &*found;
}

/// A run as a child process of ours, which makes it for all these banks from one simulation; see DegradedRuns.
RunCommand command_for(const SuiteFile& suite, const std::vector<DegradedBank>& banks) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  return [&suite, banks, program](const PlannedRun& run, const fs::path& directory) {
    std::vector<std::string> command{program, "run"};
    for (const SuiteScenario& scenario : suite.scenarios) {
      if (scenario.name != suite_scenario_of(run)) continue;
      command.push_back(scenario.path.string());
      for (const std::string& override : scenario.fixed) command.insert(command.end(), {"--set", override});
    }
    command.insert(command.end(), {"--seed", std::to_string(run.seed)});
    for (const DegradedBank& bank : banks) {
      const PlannedRun* of_bank = same_run(bank.plan, run);
      if (of_bank == nullptr) continue;
      const fs::path out = bank.root == banks.front().root ? directory : SweepPaths{bank.root}.run(of_bank->key);
      command.insert(command.end(), {"--strength", fixed_text(bank.strength, 6), "--out", out.string()});
    }
    return command;
  };
}

/// Makes what is missing of the first bank and, as it goes, the same runs of the others, which take them over when
/// their turn comes. A run's own directory is dropped once its result is stored: hundreds of maps would fill the disk.
bool fill_bank(const SuiteFile& suite, const std::vector<DegradedBank>& banks, int jobs) {
  const DegradedBank& bank = banks.front();
  SweepDirectory directory(bank.root, bank.plan, SweepDirectory::Mode::kResume);
  const auto remove_stored = [&] {
    for (const StoredRun& stored : directory.store().runs()) fs::remove_all(directory.paths().run(stored.key));
  };
  ProgressLine line(bank_name(bank.strength));
  const RunCommand command = command_for(suite, banks);
  const RunCommand tidy_command = [&](const PlannedRun& run, const fs::path& target) {
    remove_stored();
    return command(run, target);
  };
  const bool whole =
      make_runs(bank.plan, directory, tidy_command, {jobs, {}, [&line](double share) { line.update(share); }});
  remove_stored();
  return whole;
}

/// What has been made of a bank so far, written to a file that the gate can be judged by.
void keep_bank(const SuiteFile& suite, const DegradedBank& bank) {
  if (!fs::exists(SweepPaths{bank.root}.store())) return;
  const StoredSweep stored = read_sweep(bank.root);
  write_file_atomically(bank_file(bank.root.parent_path(), bank.strength),
                        baseline_json(baseline_of(suite, stored.plan, stored.runs)));
}

int prove(const ProofArguments& arguments) {
  const SuiteFile suite = read_suite_file(fs::absolute(arguments.suite));
  const std::size_t own_seeds = suite.seeds.size();
  if (static_cast<std::size_t>(arguments.bank_seeds) < own_seeds) throw InputError("--seeds: fewer than the suite has");
  const fs::path out = fs::absolute(arguments.out);
  std::vector<DegradedBank> banks{{0.0, out / bank_name(0.0), plan_of(suite, arguments.bank_seeds)}};
  for (const double strength : arguments.strengths) {
    const int seeds = std::min(arguments.degraded_seeds, arguments.bank_seeds);
    banks.push_back({strength, out / bank_name(strength), plan_of(suite, seeds)});
  }
  catch_interrupts();
  bool whole = true;
  for (std::size_t i = 0; i < banks.size() && whole && !arguments.judge_only; ++i) {
    whole = fill_bank(suite, {banks.begin() + static_cast<std::ptrdiff_t>(i), banks.end()}, arguments.jobs);
  }
  for (const DegradedBank& bank : banks) keep_bank(suite, bank);
  if (!whole) {
    std::cerr << "regress_proof: interrupted; the same command goes on" << std::endl;
    return kExitInterrupted;
  }
  const std::string text = judged_banks(out, suite, arguments.strengths, arguments.comparisons);
  write_file_atomically(out / "proof.md", text);
  std::cout << text << std::flush;
  return kExitDone;
}

int run_program(int argc, char** argv) {
  CLI::App app("Measures the regression gate", "regress_proof");
  app.set_help_flag("--help");
  ProofArguments arguments;
  app.add_option("--suite", arguments.suite, "suite file");
  app.add_option("--out", arguments.out, "directory of the banks");
  app.add_option("--seeds", arguments.bank_seeds, "seeds of the bank")->check(CLI::Range(3, 10'000));
  app.add_option("--degraded-seeds", arguments.degraded_seeds, "of the degraded ones' banks, if fewer")
      ->check(CLI::Range(3, 10'000));
  app.add_option("--jobs", arguments.jobs, "runs at a time")->check(CLI::Range(1, 1024));
  app.add_option("--comparisons", arguments.comparisons, "of the unchanged estimator")->check(CLI::Range(4, 1'000'000));
  app.add_option("--strength", arguments.strengths, "of a degraded estimator; may be given several times")
      ->check(CLI::Range(0.0, 0.99));
  app.add_flag("--judge-only", arguments.judge_only, "by the banks that --out holds, without a run");
  DegradedRuns degraded;
  std::vector<double> run_strengths;
  std::vector<std::string> run_outs;
  CLI::App* run = app.add_subcommand("run", "one simulation, by the estimator made worse in one or more ways");
  run->add_option("SCENARIO", degraded.scenario)->required();
  run->add_option("--set", degraded.overrides)->take_all()->allow_extra_args(false);
  run->add_option("--seed", degraded.seed);
  run->add_option("--strength", run_strengths)->take_all()->allow_extra_args(false)->required();
  run->add_option("--out", run_outs, "one for every --strength, in the same order")
      ->take_all()
      ->allow_extra_args(false)
      ->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  if (!*run) return prove(arguments);
  if (run_strengths.size() != run_outs.size()) throw InputError("--out: expected one for every --strength");
  for (std::size_t i = 0; i < run_outs.size(); ++i) {
    degraded.degradations.push_back({run_strengths[i], run_outs[i]});
  }
  return make_degraded_runs(degraded);
}

}  // namespace
}  // namespace plumbline

int main(int argc, char** argv) {
  try {
    return plumbline::run_program(argc, argv);
  } catch (const plumbline::InputError& error) {
    std::cerr << "regress_proof: " << error.what() << std::endl;
    return plumbline::kExitBadInput;
  }
}
