#include "tools/thesis/runner.h"

#include <algorithm>
#include <chrono>
#include <set>

#include "tools/study/run_children.h"
#include "tools/study/run_outcome.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// A run that takes so much longer than expected hangs.
constexpr double kTimeLimitFactor = 20.0;
constexpr double kLeastTimeLimit_s = 3600.0;

struct Chosen {
  const ThesisRow* row = nullptr;
  const ThesisRun* run = nullptr;
};

class Runner {
 public:
  Runner(const std::vector<ThesisRow>& rows, ThesisRuns& runs, const ThesisCommands& commands,
         const ThesisOptions& options)
      : rows_(rows), runs_(runs), commands_(commands), options_(options) {}

  bool work() {
    remove_unused_recordings();
    for (std::vector<Chosen> batch = next(); !batch.empty(); batch = next()) {
      if (!record_shared(batch) || !make(batch)) return false;
      remove_unused_recordings();
      if (options_.ended) options_.ended();
    }
    return true;
  }

 private:
  double left_s() const { return options_.budget_s - std::chrono::duration<double>(Clock::now() - start_).count(); }

  double remaining_s(const ThesisRow& row) const {
    return runs_.expected_s(row.experiment) * static_cast<double>(runs_.missing(row).size());
  }

  std::vector<const ThesisRow*> by_urgency() const {
    std::vector<const ThesisRow*> rows;
    for (const ThesisRow& row : rows_) rows.push_back(&row);
    const auto rank = [&](const ThesisRow* row) {
      const bool old = options_.has_verdict && options_.has_verdict(row->experiment.id);
      return std::pair(old, remaining_s(*row));
    };
    std::stable_sort(rows.begin(), rows.end(), [&](const auto* a, const auto* b) { return rank(a) < rank(b); });
    return rows;
  }

  /// As many runs as go at once and fit into what is left.
  std::vector<Chosen> next() const {
    std::vector<Chosen> batch;
    std::set<std::string> keys;
    const double available_s = left_s();
    for (const ThesisRow* row : by_urgency()) {
      if (runs_.expected_s(row->experiment) > available_s) continue;
      for (const ThesisRun* run : runs_.missing(*row)) {
        if (batch.size() == static_cast<std::size_t>(options_.jobs)) return batch;
        if (keys.insert(run->planned.key).second) batch.push_back({row, run});
      }
    }
    return batch;
  }

  RunLimits limits(const std::vector<Chosen>& batch) const {
    RunLimits limits;
    limits.time_s = kLeastTimeLimit_s;
    for (const Chosen& chosen : batch) {
      limits.time_s = std::max(limits.time_s, kTimeLimitFactor * runs_.expected_s(chosen.row->experiment));
    }
    return limits;
  }

  std::size_t users_left(const ThesisRun& run) const {
    std::size_t users = 0;
    for (const ThesisRow& row : rows_) {
      for (const ThesisRun* other : runs_.missing(row)) users += other->stream == run.stream ? 1U : 0U;
    }
    return users;
  }

  /// A recording that fails is none: the runs then simulate by themselves.
  bool record_shared(const std::vector<Chosen>& batch) {
    if (!commands_.record) return true;
    std::vector<ChildTask> tasks;
    std::set<std::string> streams;
    for (const Chosen& chosen : batch) {
      const fs::path directory = runs_.stream_directory(*chosen.run);
      if (users_left(*chosen.run) < 2 || fs::exists(directory) || !streams.insert(chosen.run->stream).second) continue;
      fs::create_directories(directory.parent_path());
      tasks.push_back({directory.string(), commands_.record(*chosen.run, directory)});
    }
    return run_children(
        tasks, options_.jobs, limits(batch), [](const ChildTask&) {},
        [](const ChildTask& task, const ChildEnd& end) {
          if (end.kind != ChildEnd::Kind::kExited || end.code != 0) fs::remove_all(task.key);
        });
  }

  std::vector<std::string> command_of(const ThesisRun& run) const {
    const fs::path recording = runs_.stream_directory(run);
    if (commands_.replay && fs::exists(recording)) return commands_.replay(run, recording, runs_.run_directory(run));
    return commands_.run(run, runs_.run_directory(run));
  }

  bool make(const std::vector<Chosen>& batch) {
    std::vector<ChildTask> tasks;
    for (const Chosen& chosen : batch) tasks.push_back({chosen.run->planned.key, command_of(*chosen.run)});
    const auto chosen_of = [&](const ChildTask& task) {
      return *std::find_if(batch.begin(), batch.end(), [&](const auto& c) { return c.run->planned.key == task.key; });
    };
    bool stopped = false;
    const RunLimits allowed = limits(batch);
    const bool completed = run_children(
        tasks, options_.jobs, allowed,
        [&](const ChildTask& task) {
          const Chosen chosen = chosen_of(task);
          fs::remove_all(runs_.run_directory(*chosen.run));
          if (options_.starting) options_.starting(*chosen.run, runs_.expected_s(chosen.row->experiment));
        },
        [&](const ChildTask& task, const ChildEnd& end) {
          const Chosen chosen = chosen_of(task);
          const auto outcome = outcome_of(chosen.run->planned, end, allowed, runs_.run_directory(*chosen.run));
          if (!outcome) {
            stopped = true;
            return;
          }
          runs_.add(*outcome);
          runs_.remember_cost(chosen.row->experiment, end.wall_s);
        });
    return completed && !stopped;
  }

  /// Those whose runs have all been made, and those that an older program left.
  void remove_unused_recordings() const {
    std::set<std::string> used;
    for (const ThesisRow& row : rows_) {
      for (const ThesisRun* run : runs_.missing(row)) used.insert(run->stream);
    }
    std::error_code none_there;
    for (const auto& entry : fs::directory_iterator(runs_.streams(), none_there)) {
      if (!used.contains(entry.path().filename().string())) fs::remove_all(entry.path());
    }
  }

  const std::vector<ThesisRow>& rows_;
  ThesisRuns& runs_;
  const ThesisCommands& commands_;
  const ThesisOptions& options_;
  Clock::time_point start_ = Clock::now();
};

/// plumbline VERB WHAT, on one thread, into a directory, with keys set.
std::vector<std::string> command_line(const std::string& program, const std::string& verb, const fs::path& what,
                                      const fs::path& directory, const std::vector<std::string>& keys) {
  std::vector<std::string> command{program, verb, what.string(), "--threads", "1", "--out", directory.string()};
  for (const std::string& key : keys) {
    command.emplace_back("--set");
    command.push_back(key);
  }
  return command;
}

}  // namespace

ThesisCommands plumbline_commands(const std::string& program) {
  ThesisCommands commands;
  commands.run = [program](const ThesisRun& run, const fs::path& directory) {
    std::vector<std::string> command = command_line(program, "run", run.scenario, directory, run.overrides);
    command.insert(command.end(), {"--seed", std::to_string(run.planned.seed)});
    return command;
  };
  commands.record = [program](const ThesisRun& run, const fs::path& directory) {
    std::vector<std::string> command = command_line(program, "export", run.scenario, directory, run.overrides);
    command.insert(command.end(), {"--format", "plumbline", "--seed", std::to_string(run.planned.seed)});
    return command;
  };
  commands.replay = [program](const ThesisRun& run, const fs::path& recording, const fs::path& directory) {
    std::vector<std::string> command = command_line(program, "replay", recording, directory, run.replay_keys);
    command.insert(command.end(), {"--format", "plumbline"});
    return command;
  };
  return commands;
}

bool run_thesis(const std::vector<ThesisRow>& chosen, ThesisRuns& runs, const ThesisCommands& commands,
                const ThesisOptions& options) {
  return Runner(chosen, runs, commands, options).work();
}

}  // namespace plumbline
