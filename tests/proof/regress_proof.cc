// What the regression gate is worth: how often it fails an unchanged estimator, and how often it catches one that was
// really made worse, measured on a bank of runs that is made once and kept. It can be stopped and started again.
#include <CLI/CLI.hpp>
#include <cmath>
#include <fstream>
#include <iostream>

#include "scenarios/input_error.h"
#include "tests/proof/degraded_run.h"
#include "tests/proof/resampling.h"
#include "tools/evaluation/quantile.h"
#include "tools/exit_code.h"
#include "tools/formats/number_text.h"
#include "tools/interrupt.h"
#include "tools/output/atomic_file.h"
#include "tools/progress_line.h"
#include "tools/study/suite_plan.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

struct ProofArguments {
  std::string suite = PLUMBLINE_SCENARIO_DIR "/suites/ci.yaml";
  std::string out = "out/regress-proof";
  int bank_seeds = 64;
  int jobs = 1;
  int comparisons = 4000;
  bool judge_only = false;
  std::vector<double> strengths;  ///< of degradation; each has a bank of its own
};

std::string bank_name(double strength) { return strength == 0.0 ? "itself" : "degraded_" + fixed_text(strength, 3); }

/// A run as a child process of ours; see DegradedRun.
RunCommand degraded_command(const SuiteFile& suite, double strength) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  return [&suite, strength, program](const PlannedRun& run, const fs::path& directory) {
    std::vector<std::string> command{program, "run"};
    for (const SuiteScenario& scenario : suite.scenarios) {
      if (scenario.name != suite_scenario_of(run)) continue;
      command.push_back(scenario.path.string());
      for (const std::string& override : scenario.fixed) command.insert(command.end(), {"--set", override});
    }
    command.insert(command.end(), {"--seed", std::to_string(run.seed), "--out", directory.string(), "--strength",
                                   fixed_text(strength, 6)});
    return command;
  };
}

/// Makes what is missing of a bank. A run's own directory is dropped once its result is stored: hundreds of maps
/// would fill the disk.
bool fill_bank(const SuiteFile& suite, const SweepPlan& plan, const fs::path& root, double strength, int jobs) {
  SweepDirectory directory(root, plan, SweepDirectory::Mode::kResume);
  ProgressLine line(bank_name(strength));
  const RunCommand command = degraded_command(suite, strength);
  const RunCommand tidy_command = [&](const PlannedRun& run, const fs::path& target) {
    for (const StoredRun& stored : directory.store().runs()) fs::remove_all(directory.paths().run(stored.key));
    return command(run, target);
  };
  return make_runs(plan, directory, tidy_command, {jobs, {}, [&line](double share) { line.update(share); }});
}

std::vector<MeasuredRun> bank_of(const fs::path& root) {
  const StoredSweep stored = read_sweep(root);
  return measured_runs(stored.plan, stored.runs);
}

/// Keeps of each bank the runs that all of them have.
void keep_common(std::vector<std::vector<MeasuredRun>>& banks) {
  for (std::vector<MeasuredRun>& bank : banks) {
    std::erase_if(bank, [&](const MeasuredRun& run) {
      return std::any_of(banks.begin(), banks.end(), [&](const std::vector<MeasuredRun>& other) {
        return !std::binary_search(other.begin(), other.end(), run, before_in_suite);
      });
    });
  }
}

double median_drift(const std::vector<MeasuredRun>& bank) {
  std::vector<double> drifts;
  for (const MeasuredRun& run : bank) drifts.push_back(run.drift_percent.value_or(0.0));
  return quantile(drifts, 0.5).value_or(0.0);
}

std::size_t fewest_seeds(const std::vector<MeasuredRun>& bank) {
  std::map<std::string, std::size_t> seeds;
  for (const MeasuredRun& run : bank) ++seeds[run.scenario];
  std::size_t fewest = bank.size();
  for (const auto& [scenario, count] : seeds) fewest = std::min(fewest, count);
  return fewest;
}

std::string rate_text(const FailureCount& count) {
  return std::to_string(count.failed) + " of " + std::to_string(count.of) + " (" + readable_text(100.0 * count.rate()) +
         " %; 95 % bounds " + readable_text(100.0 * lower_bound_95(count)) + " … " +
         readable_text(100.0 * upper_bound_95(count)) + " %)";
}

std::string judged(const ProofArguments& arguments, const SuiteFile& suite) {
  const std::size_t seeds = suite.seeds.size();
  const auto times = static_cast<std::size_t>(arguments.comparisons);
  const std::vector<MeasuredRun> itself = bank_of(fs::path(arguments.out) / bank_name(0.0));
  std::string text = "# The regression gate, measured\n\nSuite " + suite.name + ", " +
                     std::to_string(suite.scenarios.size()) + " scenarios of " + std::to_string(seeds) +
                     " seeds; bank of " + std::to_string(itself.size()) + " runs, at least " +
                     std::to_string(fewest_seeds(itself)) + " seeds a scenario.\n\n";
  if (fewest_seeds(itself) >= 2 * seeds) {
    text += "- unchanged, disjoint seeds: fails " + rate_text(against_itself(itself, seeds, times)) + "\n";
  } else {
    text += "- unchanged, disjoint seeds: the bank is too small yet\n";
  }
  for (const double strength : arguments.strengths) {
    std::vector<std::vector<MeasuredRun>> banks{itself, bank_of(fs::path(arguments.out) / bank_name(strength))};
    keep_common(banks);
    const Comparison whole = compare_runs(banks[0], banks[1], suite.effects, true);
    const Change& main = whole.changes.front();
    text += "- degraded by " + readable_text(strength) + " over " + std::to_string(whole.pairs.size()) +
            " pairs: pooled 1 s error grown by " + readable_text(main.percent.value) + " % (" +
            readable_text(main.percent.low) + " … " + readable_text(main.percent.high) + "), median drift " +
            readable_text(median_drift(banks[0])) + " → " + readable_text(median_drift(banks[1])) + " %; ";
    if (fewest_seeds(banks[0]) < seeds) {
      text += "the bank is too small yet\n";
      continue;
    }
    const FailureCount caught = against_each_other(banks[0], banks[1], seeds, times / 4);
    text +=
        "caught " + rate_text(caught) + ", by the main figure alone " + std::to_string(caught.by_main_figure) + "\n";
  }
  return text;
}

int prove(const ProofArguments& arguments) {
  SuiteFile suite = read_suite_file(fs::absolute(arguments.suite));
  const std::size_t own_seeds = suite.seeds.size();
  SuiteFile bank = suite;
  bank.seeds.clear();
  for (int seed = 1; seed <= arguments.bank_seeds; ++seed) bank.seeds.push_back(static_cast<std::uint64_t>(seed));
  if (bank.seeds.size() < own_seeds) throw InputError("--seeds: fewer than the suite itself has");
  const fs::path out = fs::absolute(arguments.out);
  const SweepPlan plan = suite_plan(bank, {});
  std::vector<double> strengths{0.0};
  strengths.insert(strengths.end(), arguments.strengths.begin(), arguments.strengths.end());
  catch_interrupts();
  for (const double strength : strengths) {
    if (arguments.judge_only) break;
    if (fill_bank(bank, plan, out / bank_name(strength), strength, arguments.jobs)) continue;
    std::cerr << "regress_proof: interrupted; the same command goes on" << std::endl;
    return kExitInterrupted;
  }
  const std::string text = judged(arguments, suite);
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
  app.add_option("--jobs", arguments.jobs, "runs at a time")->check(CLI::Range(1, 1024));
  app.add_option("--comparisons", arguments.comparisons, "of the unchanged estimator")->check(CLI::Range(4, 1'000'000));
  app.add_option("--strength", arguments.strengths, "of a degraded estimator; may be given several times")
      ->check(CLI::Range(0.0, 0.99));
  app.add_flag("--judge-only", arguments.judge_only, "with what the banks hold");
  DegradedRun degraded;
  std::string out;
  CLI::App* run = app.add_subcommand("run", "one run of an estimator made worse");
  run->add_option("SCENARIO", degraded.scenario)->required();
  run->add_option("--set", degraded.overrides)->take_all()->allow_extra_args(false);
  run->add_option("--seed", degraded.seed);
  run->add_option("--out", out)->required();
  run->add_option("--strength", degraded.strength);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  if (!*run) return prove(arguments);
  degraded.out = out;
  return make_degraded_run(degraded);
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
