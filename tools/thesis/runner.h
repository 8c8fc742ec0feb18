#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tools/thesis/runs.h"

namespace plumbline {

/// How runs become processes: program and arguments, to write into that directory.
struct ThesisCommands {
  std::function<std::vector<std::string>(const ThesisRun&, const std::filesystem::path& directory)> run;
  /// Records the run's sensors, and runs its estimator on such a recording. Empty: every run simulates by itself.
  std::function<std::vector<std::string>(const ThesisRun&, const std::filesystem::path& directory)> record;
  std::function<std::vector<std::string>(const ThesisRun&, const std::filesystem::path& recording,
                                         const std::filesystem::path& directory)>
      replay;
};

/// `plumbline run`, `export` and `replay`, each on one thread.
ThesisCommands plumbline_commands(const std::string& program);

struct ThesisOptions {
  int jobs = 1;
  double budget_s = std::numeric_limits<double>::infinity();  ///< no run starts that is not expected to end within
  /// Whether a row has a verdict already, if an older program's: such rows come last.
  std::function<bool(const std::string& id)> has_verdict;
  std::function<void(const ThesisRun& run, double expected_s)> starting;
  std::function<void()> ended;  ///< after every run, or every few that ran at once
};

/// Makes the runs that have not been made, rows without a verdict first, then what costs least.
/// @param chosen  of the rows, those to work on
/// @returns whether it came to its end or its budget's; if not, it was interrupted
/// @throws InputError if results cannot be written; what is stored stays
bool run_thesis(const std::vector<ThesisRow>& chosen, ThesisRuns& runs, const ThesisCommands& commands,
                const ThesisOptions& options);

}  // namespace plumbline
