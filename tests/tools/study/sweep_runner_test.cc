#include "tools/study/sweep_runner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <set>
#include <thread>

#include "scenarios/input_error.h"
#include "tests/scenarios/temporary_directory.h"
#include "tools/interrupt.h"
#include "tools/study/sweep_merge.h"
#include "tools/study/sweep_tables.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// In place of the program: $1 the run's key, $2 its directory, $3 the provenance of its result, $4 the log of calls.
/// A result appears by rename, as a real one does.
constexpr const char* kStub = R"sh(
echo "$1" >> "$4"
case "$1" in
  0001) [ -n "$CRASH" ] && kill -SEGV $$ ;;
  0002) [ -n "$HANG" ] && exec sleep 100 ;;
  0003) [ -n "$GREED" ] && exec tail /dev/zero ;;
  0004) [ -n "$REFUSAL" ] && { echo "plumbline: no such route" >&2; exit 2; } ;;
  0005) [ -n "$FULL" ] && { echo "plumbline: fault: cannot be written: No space left on device" >&2; exit 3; } ;;
esac
sleep 0.03
mkdir -p "$2.part"
result='{"status":"ok","drift_percent":0.5%s,"real_time_factor":%s,"wall_s":0.1,"provenance":%s}'
printf "$result" "$1" "$$" "$3" > "$2.part/result.json"
exec mv "$2.part" "$2"
)sh";

class SweepRunnerTest : public ::testing::Test {
 protected:
  SweepRunnerTest() {
    directory_.write("base.yaml", "motion:\n  waypoints: [[4, 4.75, 1.5], [24, 4.75, 1.5]]\n");
    directory_.write("stub.sh", kStub);
    plan_ = plan_of("axes: {world.light.lux: [1, 10, 100, 1000]}\nseeds: 3\nlimits: {time_s: 20}");
  }

  SweepPlan plan_of(const std::string& text) const {
    return make_plan(read_sweep_file(directory_.write("sweep.yaml", "scenario: base.yaml\n" + text)));
  }
  fs::path place(const std::string& name) const { return directory_.path() / name; }
  fs::path log() const { return place("calls.log"); }

  RunCommand stub(const std::string& variable = "NOTHING") const {
    return [this, variable](const PlannedRun& run, const fs::path& target) {
      // "0.1.0 (7c7af71)", or without a commit just the version.
      const auto space = plan_.program.find(" (");
      const bool has_commit = space != std::string::npos;
      std::string provenance = "{\"version\":\"" + plan_.program.substr(0, space) + "\"";
      if (has_commit) {
        provenance += ",\"git_commit\":\"" + plan_.program.substr(space + 2, plan_.program.size() - space - 3) + "\"";
      }
      provenance += ",\"scenario_digest\":\"" + run.scenario_digest + "\",\"seed\":" + std::to_string(run.seed) +
                    ",\"estimator\":\"" + run.estimator + "\"}";
      return std::vector<std::string>{"/usr/bin/env", variable + "=1", "/bin/sh",  place("stub.sh").string(),
                                      run.key,        target.string(), provenance, log().string()};
    };
  }

  std::vector<RunRow> run_into(const std::string& name, SweepDirectory::Mode mode, int jobs = 2, Shard shard = {},
                               const std::string& variable = "NOTHING") const {
    SweepDirectory directory(place(name), plan_, mode);
    make_runs(plan_, directory, stub(variable), {jobs, shard, {}});
    return directory.rows();
  }
  std::string tables(const std::vector<RunRow>& rows) const {
    return table_csv(plan_, rows) + table_jsonl(plan_, rows);
  }

  std::vector<std::string> calls() const {
    std::ifstream file(log());
    std::vector<std::string> calls;
    for (std::string key; file >> key;) calls.push_back(key);
    return calls;
  }
  /// Starts a sweep in a process of its own and waits until some runs have been called.
  pid_t sweep_apart(const std::string& name, std::size_t called) const {
    const pid_t process = fork();
    if (process == 0) {
      catch_interrupts();
      SweepDirectory directory(place(name), plan_, SweepDirectory::Mode::kNew);
      _exit(make_runs(plan_, directory, stub(), {2, {}, {}}) ? 0 : 130);
    }
    while (calls().size() < called) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return process;
  }
  std::string refusal(const std::function<void()>& action) const {
    try {
      action();
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryDirectory directory_;
  SweepPlan plan_;
};

constexpr auto kNew = SweepDirectory::Mode::kNew;
constexpr auto kResume = SweepDirectory::Mode::kResume;

TEST_F(SweepRunnerTest, JobsAndShardsChangeNoByteOfTheTables) {
  const std::string one = tables(run_into("one", kNew, 1));
  EXPECT_EQ(tables(run_into("three", kNew, 3)), one);
  run_into("a", kNew, 2, {1, 2});
  EXPECT_EQ(run_into("b", kNew, 1, {2, 2}).size(), 6U);
  const MergedSweep merged = merge_sweeps({place("b"), place("a")}, place("whole"));
  EXPECT_EQ(tables(merged.rows), one);
  EXPECT_TRUE(fs::exists(place("whole/runs/0007/result.json")));
  EXPECT_EQ(one.find("real_time_factor"), std::string::npos);
}

TEST_F(SweepRunnerTest, KilledAtAnyMomentItGoesOnWithoutLosingOrRepeatingARun) {
  const std::string whole = tables(run_into("whole", kNew));
  for (const std::size_t called : {1U, 4U, 9U}) {
    fs::remove(log());
    const std::string name = "killed" + std::to_string(called);
    const pid_t process = sweep_apart(name, called);
    kill(process, SIGKILL);
    waitpid(process, nullptr, 0);
    std::set<std::string> finished;
    for (const auto& entry : fs::directory_iterator(place(name + "/runs"))) {
      if (fs::exists(entry.path() / "result.json") && entry.path().extension() != ".part") {
        finished.insert(entry.path().filename());
      }
    }
    fs::remove(log());
    EXPECT_EQ(tables(run_into(name, kResume)), whole);
    for (const std::string& key : calls()) EXPECT_FALSE(finished.contains(key)) << key << " was made twice";
    EXPECT_EQ(calls().size() + finished.size(), plan_.runs.size());
  }
}

TEST_F(SweepRunnerTest, AnInterruptKeepsWhatHasFinished) {
  const pid_t process = sweep_apart("sweep", 5);
  kill(process, SIGINT);
  int status = 0;
  waitpid(process, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_GE(read_sweep(place("sweep")).runs.size(), 3U);
  EXPECT_EQ(run_into("sweep", kResume).size(), plan_.runs.size());
}

TEST_F(SweepRunnerTest, EveryWayToEndIsThatRunsOutcomeAlone) {
  const std::vector<RunRow> crash = run_into("crash", kNew, 2, {}, "CRASH");
  EXPECT_EQ(crash[1].outcome, "crashed");
  EXPECT_THAT(crash[1].reason, HasSubstr("signal 11"));
  EXPECT_EQ(crash[1].status, "error");
  plan_.limits.time_s = 0.5;
  const std::vector<RunRow> hang = run_into("hang", kNew, 2, {}, "HANG");
  EXPECT_EQ(hang[2].outcome, "time_limit");
  const std::vector<RunRow> refused = run_into("refused", kNew, 2, {}, "REFUSAL");
  EXPECT_EQ(refused[4].outcome, "refused");
  EXPECT_EQ(refused[4].reason, "plumbline: no such route");
  for (const auto* rows : {&crash, &hang, &refused}) {
    ASSERT_EQ(rows->size(), plan_.runs.size());
    EXPECT_TRUE(rows->back().is_ok());
  }
}

TEST_F(SweepRunnerTest, MemoryBeyondTheLimitEndsTheRun) {
  // Far enough below the data limit of twice as much that the watch comes first.
  plan_.limits.memory_mb = 200.0;
  const std::vector<RunRow> rows = run_into("greed", kNew, 1, {}, "GREED");
  EXPECT_EQ(rows[3].outcome, "memory_limit");
  EXPECT_EQ(rows[3].reason, "took more memory than its limit of 200 MB");
}

TEST_F(SweepRunnerTest, AFullDiskIsNotTheRunsFault) {
  EXPECT_THAT(refusal([&] { run_into("sweep", kNew, 1, {}, "FULL"); }), HasSubstr("No space left on device"));
  EXPECT_EQ(read_sweep(place("sweep")).runs.size(), 5U);
  const std::vector<RunRow> rows = run_into("sweep", kResume);
  EXPECT_EQ(rows.size(), plan_.runs.size());
  EXPECT_TRUE(rows[5].is_ok());
}

TEST_F(SweepRunnerTest, OnePlaceHoldsOneSweep) {
  run_into("sweep", kNew);
  EXPECT_THAT(refusal([&] { run_into("sweep", kNew); }), HasSubstr("--resume goes on with it"));
  {
    const SweepDirectory held(place("sweep"), plan_, kResume);
    EXPECT_THAT(refusal([&] { run_into("sweep", kResume); }), HasSubstr("another sweep is writing here"));
  }
  plan_ = plan_of("axes: {world.light.lux: [1, 10]}");
  EXPECT_THAT(refusal([&] { run_into("sweep", kResume); }), HasSubstr("differs in: axes"));
  directory_.write("thesis.txt", "years of work");
  EXPECT_THAT(refusal([&] { run_into("", kNew); }), HasSubstr("holds no sweep"));
  EXPECT_THAT(refusal([&] { run_into("thesis.txt/sweep", kNew); }), HasSubstr("cannot be created"));
}

TEST_F(SweepRunnerTest, ADamagedDatabaseIsNamedAndCostsNoFinishedRun) {
  const std::string whole = tables(run_into("sweep", kNew));
  std::ofstream(place("sweep/sweep.sqlite"))
      << "this is not a database, whatever its name says" << std::string(9000, 'x');
  EXPECT_THAT(refusal([&] { run_into("sweep", kResume); }), HasSubstr("damaged database"));
  fs::remove(place("sweep/sweep.sqlite"));
  fs::remove(log());
  EXPECT_EQ(tables(run_into("sweep", kResume)), whole);
  EXPECT_TRUE(calls().empty());
}

TEST_F(SweepRunnerTest, OnlyShardsOfOneSweepMerge) {
  run_into("a", kNew, 2, {1, 2});
  plan_ = plan_of("seeds: 4");
  run_into("other", kNew);
  EXPECT_THAT(refusal([&] {
                merge_sweeps({place("a"), place("other")}, place("m"));
              }),
              HasSubstr("another sweep than"));
  EXPECT_THAT(refusal([&] { merge_sweeps({place("nowhere")}, place("m")); }), HasSubstr("holds no sweep"));
}

TEST_F(SweepRunnerTest, ABoundaryIsFoundByTheSameRunsForAnyNumberOfJobs) {
  plan_ =
      plan_of("axes: {world.light.lux: {log_range: [1, 1000], count: 9}}\nseeds: 3\nfind_boundary: world.light.lux");
  const std::vector<RunRow> one = run_into("one", kNew, 1);
  EXPECT_LE(3 * one.size(), plan_.runs.size());
  EXPECT_GT(one.size(), 3U);
  EXPECT_EQ(tables(run_into("three", kNew, 3)), tables(one));
}

}  // namespace
}  // namespace plumbline
