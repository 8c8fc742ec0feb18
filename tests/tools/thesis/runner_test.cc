#include "tools/thesis/runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/thesis/experiment_text.h"
#include "tools/thesis/page.h"
#include "tools/thesis/results.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// In place of the program: $1 what to do, $2 where, $3 the log, $4 a run's label, $5 a recording.
constexpr const char* kStub = R"sh(
echo "$1 $4" >> "$3"
[ "$1" = record ] && [ -n "$NO_RECORDING" ] && exit 3
[ "$1" = replay ] && { [ -f "$5/result.json" ] || exit 3; }
mkdir -p "$2.part"
echo '{"status":"ok","drift_percent":0.5,"distance_m":100}' > "$2.part/result.json"
exec mv "$2.part" "$2"
)sh";

constexpr const char* kTable =
    "experiments:\n"
    "  - {id: long, claim: c, thesis: '< 1 %', scenario: scenario.yaml, figure: drift_percent, seeds: 3,\n"
    "     simulated_s: 500, configurations: [{name: fast, set: {motion.speed_mps: 2}}], checks: [{max: 1}]}\n"
    "  - {id: short, claim: c, thesis: '< 1 %', scenario: scenario.yaml, figure: drift_percent, seeds: 3,\n"
    "     simulated_s: 10, configurations: [{name: vloam}, {name: vio, estimator: vio}], checks: [{max: 1}]}\n"
    "  - {id: same, claim: c, thesis: '< 1 %', scenario: scenario.yaml, figure: drift_percent, seeds: 3,\n"
    "     simulated_s: 20, configurations: [{name: all}, {name: none_such, estimator: crystal_ball}],\n"
    "     checks: [{max: 1}]}\n";

class ThesisRunnerTest : public ::testing::Test {
 protected:
  ThesisRunnerTest() {
    directory_.write("scenario.yaml", "motion:\n  waypoints: [[4, 4.75, 1.5], [24, 4.75, 1.5]]\n");
    directory_.write("stub.sh", kStub);
    experiments_ = read_experiments(directory_.write("experiments.yaml", kTable));
  }

  std::vector<std::string> stub(const std::string& what, const ThesisRun& run, const fs::path& where,
                                const std::string& recording = "") const {
    return {"/usr/bin/env", variable_ + "=1", "/bin/sh", (directory_.path() / "stub.sh").string(), what, where.string(),
            log().string(), run.label,        recording};
  }
  ThesisCommands commands(bool recording) const {
    ThesisCommands commands;
    commands.run = [this](const ThesisRun& run, const fs::path& where) { return stub("run", run, where); };
    if (!recording) return commands;
    commands.record = [this](const ThesisRun& run, const fs::path& where) { return stub("record", run, where); };
    commands.replay = [this](const ThesisRun& run, const fs::path& from, const fs::path& where) {
      return stub("replay", run, where, from.string());
    };
    return commands;
  }
  bool run(const std::vector<ThesisRow>& rows, const ThesisOptions& options = {}, bool recording = false) const {
    ThesisRuns runs(directory_.path() / "out");
    return run_thesis(rows, runs, commands(recording), options);
  }
  std::vector<ThesisRow> plan(const std::string& program = "1.0 (abc)") const {
    return plan_thesis(experiments_, program);
  }

  fs::path log() const { return directory_.path() / "calls.log"; }
  std::vector<std::string> calls() const {
    std::ifstream file(log());
    std::vector<std::string> calls;
    for (std::string line; std::getline(file, line);) calls.push_back(line);
    return calls;
  }

  TemporaryDirectory directory_;
  std::vector<Experiment> experiments_;
  std::string variable_ = "NOTHING";
};

TEST_F(ThesisRunnerTest, CheapRowsComeFirstAndWhatRowsShareRunsOnce) {
  EXPECT_TRUE(run(plan()));
  EXPECT_THAT(calls(), ElementsAre("run short vloam seed 1", "run short vio seed 1", "run short vloam seed 2",
                                   "run short vio seed 2", "run short vloam seed 3", "run short vio seed 3",
                                   "run long fast seed 1", "run long fast seed 2", "run long fast seed 3"));
}

TEST_F(ThesisRunnerTest, GoesOnWhereItWasStopped) {
  const std::vector<ThesisRow> rows = plan();
  {
    ThesisRuns runs(directory_.path() / "out");
    StoredRun stored;
    stored.outcome = "finished";
    stored.result = R"({"status":"ok","drift_percent":0.4})";
    for (const ThesisRun& run : rows[1].runs[0]) {
      stored.key = run.planned.key;
      runs.add(stored);
    }
    // Said nothing about the run but that the machine was slow.
    stored.key = rows[1].runs[1][2].planned.key;
    stored.outcome = "time_limit";
    runs.add(stored);
  }
  EXPECT_TRUE(run(rows));
  EXPECT_THAT(calls(), ElementsAre("run short vio seed 1", "run short vio seed 2", "run short vio seed 3",
                                   "run long fast seed 1", "run long fast seed 2", "run long fast seed 3"));
  EXPECT_TRUE(run(rows));
  EXPECT_EQ(calls().size(), 6U) << "nothing was left to do";
  EXPECT_TRUE(run(plan("1.0 (abd)")));
  EXPECT_EQ(calls().size(), 15U) << "another version starts anew";
}

TEST_F(ThesisRunnerTest, StartsNothingThatDoesNotFitIntoTheBudget) {
  ThesisOptions options;
  options.budget_s = 200.0;
  EXPECT_TRUE(run(plan(), options));
  EXPECT_EQ(calls().size(), 6U) << "the long row alone is expected to take longer";
}

TEST_F(ThesisRunnerTest, RowsWithoutAVerdictComeFirst) {
  ThesisOptions options;
  options.has_verdict = [](const std::string& id) { return id != "long"; };
  EXPECT_TRUE(run(plan(), options));
  EXPECT_EQ(calls().front(), "run long fast seed 1");
}

TEST_F(ThesisRunnerTest, SensorsThatConfigurationsShareAreRecordedOnce) {
  std::vector<ThesisRow> rows = plan();
  rows.erase(rows.begin());
  EXPECT_TRUE(run(rows, {}, true));
  EXPECT_THAT(calls(),
              ElementsAre("record short vloam seed 1", "replay short vloam seed 1", "replay short vio seed 1",
                          "record short vloam seed 2", "replay short vloam seed 2", "replay short vio seed 2",
                          "record short vloam seed 3", "replay short vloam seed 3", "replay short vio seed 3"));
  EXPECT_TRUE(fs::is_empty(directory_.path() / "out/streams")) << "recordings go when nobody needs them";
}

TEST_F(ThesisRunnerTest, WithoutARecordingEveryRunSimulates) {
  variable_ = "NO_RECORDING";
  std::vector<ThesisRow> rows = plan();
  rows.erase(rows.begin());
  EXPECT_TRUE(run(rows, {}, true));
  const std::vector<std::string> said = calls();
  EXPECT_EQ(std::count(said.begin(), said.end(), "run short vio seed 3"), 1);
}

TEST_F(ThesisRunnerTest, ResultsAndPageSayWhatIsKnown) {
  const std::vector<ThesisRow> rows = plan();
  EXPECT_TRUE(run(rows));
  std::vector<RowResult> results;
  {
    const ThesisRuns runs(directory_.path() / "out");
    for (const ThesisRow& row : rows) {
      results.push_back(row_result(row.experiment, runs.of(row), row.impossible, "1.0 (abc)"));
    }
  }
  const auto json = nlohmann::json::parse(results_json(results));
  ASSERT_EQ(json.at("rows").size(), 3U);
  for (const auto& row : json.at("rows")) {
    for (const char* key : {"id", "claim", "thesis", "ours", "spread", "seeds", "holds", "version"}) {
      EXPECT_TRUE(row.contains(key)) << key;
    }
  }
  EXPECT_EQ(json["rows"][0]["ours"], "0.500 %");
  EXPECT_EQ(json["rows"][0]["holds"], true);
  EXPECT_EQ(json["rows"][0]["seeds"], 3);
  EXPECT_EQ(json["rows"][0]["version"], "1.0 (abc)");
  EXPECT_TRUE(json["rows"][2]["holds"].is_null()) << "one of its configurations cannot be run";
  EXPECT_THAT(json["rows"][2]["note"].get<std::string>(), HasSubstr("crystal_ball"));

  // What was written is read back, and an older version's verdict stands until there is a newer one.
  const std::vector<RowResult> read = read_results(directory_.write("results.json", results_json(results)));
  EXPECT_EQ(results_json(read), results_json(results));
  const ThesisRuns nothing(directory_.path() / "fresh");
  const ThesisRow& row = rows.front();
  const RowResult unrun = row_result(row.experiment, nothing.of(row), row.impossible, "1.1");
  EXPECT_EQ(nlohmann::json::parse(results_json({unrun}))["rows"][0]["ours"], nullptr);
  EXPECT_EQ(newer(unrun, read).version, "1.0 (abc)");
  Experiment stricter = row.experiment;
  stricter.checks.front().max = 0.1;
  EXPECT_EQ(newer(row_result(stricter, nothing.of(row), "", "1.1"), read).version, "")
      << "a verdict on other checks does not";

  const std::string page = thesis_page(results, {{"long", {{"fast seed 1", "runs/x/report.html"}}}});
  EXPECT_THAT(page, HasSubstr("&lt; 1 %"));
  EXPECT_THAT(page, HasSubstr("runs/x/report.html"));
  EXPECT_THAT(page, HasSubstr("<svg"));
}

}  // namespace
}  // namespace plumbline
