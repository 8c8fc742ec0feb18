#include "tests/proof/bank_judgement.h"

#include <algorithm>
#include <map>

#include "tests/proof/resampling.h"
#include "tools/evaluation/quantile.h"
#include "tools/formats/number_text.h"
#include "tools/study/baseline.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

std::string bank_name(double strength) { return strength == 0.0 ? "itself" : "degraded_" + fixed_text(strength, 3); }

fs::path bank_file(const fs::path& directory, double strength) { return directory / (bank_name(strength) + ".json"); }

void keep_common(std::vector<std::vector<MeasuredRun>>& banks) {
  for (std::vector<MeasuredRun>& bank : banks) {
    std::erase_if(bank, [&](const MeasuredRun& run) {
      return std::any_of(banks.begin(), banks.end(), [&](const std::vector<MeasuredRun>& other) {
        return !std::binary_search(other.begin(), other.end(), run, before_in_suite);
      });
    });
  }
}

std::string judged_banks(const fs::path& directory, const SuiteFile& suite, const std::vector<double>& strengths,
                         int comparisons) {
  const std::size_t seeds = suite.seeds.size();
  const auto times = static_cast<std::size_t>(comparisons);
  const std::vector<MeasuredRun> itself = read_baseline(bank_file(directory, 0.0)).runs;
  std::string text = "# The regression gate, measured\n\nSuite " + suite.name + ", " +
                     std::to_string(suite.scenarios.size()) + " scenarios of " + std::to_string(seeds) +
                     " seeds; bank of " + std::to_string(itself.size()) + " runs, at least " +
                     std::to_string(fewest_seeds(itself)) + " seeds a scenario.\n\n";
  if (fewest_seeds(itself) >= 2 * seeds) {
    text += "- unchanged, disjoint seeds: fails " + rate_text(against_itself(itself, seeds, times)) + "\n";
  } else {
    text += "- unchanged, disjoint seeds: the bank is too small yet\n";
  }
  for (const double strength : strengths) {
    std::vector<std::vector<MeasuredRun>> banks{itself, read_baseline(bank_file(directory, strength)).runs};
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

}  // namespace plumbline
