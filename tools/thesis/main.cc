// thesis_suite: runs the experiments of scenarios/thesis/ and says which of the thesis's claims hold.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"
#include "tools/exit_code.h"
#include "tools/formats/number_text.h"
#include "tools/interrupt.h"
#include "tools/output/atomic_file.h"
#include "tools/output/provenance.h"
#include "tools/thesis/page.h"
#include "tools/thesis/results.h"
#include "tools/thesis/runner.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<std::string> ids;
  double budget_min = 0.0;
  int jobs = 1;
  bool list = false;
  std::string table = "scenarios/thesis/experiments.yaml";
  std::string results = "scenarios/thesis/results.json";
  std::string out = "out/thesis";
  std::string program;
};

std::vector<ThesisRow> chosen_rows(const std::vector<ThesisRow>& rows, const std::vector<std::string>& ids) {
  if (ids.empty()) return rows;
  std::vector<ThesisRow> chosen;
  for (const std::string& id : ids) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const ThesisRow& r) { return r.experiment.id == id; });
    if (row == rows.end()) {
      std::vector<std::string> known;
      for (const ThesisRow& r : rows) known.push_back(r.experiment.id);
      throw InputError("found the experiment '" + id + "', expected one of: " + joined(known));
    }
    chosen.push_back(*row);
  }
  return chosen;
}

/// What is published: every row's state, as a file for machines and as a page.
class Publication {
 public:
  Publication(const Arguments& arguments, const std::vector<ThesisRow>& rows, const ThesisRuns& runs)
      : results_(arguments.results), rows_(rows), runs_(runs), before_(read_results(arguments.results)) {}

  std::vector<RowResult> results() const {
    std::vector<RowResult> results;
    for (const ThesisRow& row : rows_) {
      results.push_back(newer(row_result(row.experiment, runs_.of(row), row.impossible, program_version()), before_));
    }
    return results;
  }

  void write() const {
    const std::vector<RowResult> rows = results();
    write_file_atomically(results_, results_json(rows));
    write_file_atomically(runs_.page(), thesis_page(rows, links()));
  }

 private:
  RunLinks links() const {
    RunLinks links;
    for (const ThesisRow& row : rows_) {
      for (const auto& of_configuration : row.runs) {
        for (const ThesisRun& run : of_configuration) {
          if (!fs::exists(runs_.run_directory(run) / "report.html")) continue;
          links[row.experiment.id].emplace_back(run.label.substr(row.experiment.id.size() + 1),
                                                "runs/" + run.planned.key + "/report.html");
        }
      }
    }
    return links;
  }

  fs::path results_;
  const std::vector<ThesisRow>& rows_;
  const ThesisRuns& runs_;
  std::vector<RowResult> before_;
};

const char* verdict_word(const std::optional<bool>& holds) {
  if (!holds) return "open";
  return *holds ? "holds" : "DOES NOT HOLD";
}

void list_rows(const std::vector<ThesisRow>& rows, const ThesisRuns& runs, const std::vector<RowResult>& results) {
  for (const ThesisRow& row : rows) {
    const auto result =
        std::find_if(results.begin(), results.end(), [&](const RowResult& r) { return r.id == row.experiment.id; });
    const auto missing = static_cast<double>(runs.missing(row).size());
    std::cout << row.experiment.id << ": " << verdict_word(result->judgement.holds) << "; " << missing
              << " runs to make, some " << readable_text(missing * runs.expected_s(row.experiment) / 60.0) << " min; "
              << (result->judgement.ours.empty() ? "" : result->judgement.ours + "; ") << result->judgement.note
              << "\n";
  }
}

ExitCode run(const Arguments& arguments) {
  const std::vector<ThesisRow> rows =
      plan_thesis(read_experiments(arguments.table), program_identity(arguments.program));
  const std::vector<ThesisRow> chosen = chosen_rows(rows, arguments.ids);
  ThesisRuns runs(fs::absolute(arguments.out));
  const Publication publication(arguments, rows, runs);
  publication.write();
  if (arguments.list) {
    list_rows(chosen, runs, publication.results());
    return kExitDone;
  }
  ThesisOptions options;
  options.jobs = arguments.jobs;
  if (arguments.budget_min > 0.0) options.budget_s = 60.0 * arguments.budget_min;
  const std::vector<RowResult> before = publication.results();
  options.has_verdict = [&before](const std::string& id) {
    return std::any_of(before.begin(), before.end(),
                       [&](const RowResult& row) { return row.id == id && row.judgement.holds.has_value(); });
  };
  options.starting = [](const ThesisRun& run, double expected_s) {
    std::cout << run.label << ", some " << readable_text(expected_s / 60.0) << " min" << std::endl;
  };
  options.ended = [&publication] { publication.write(); };
  catch_interrupts();
  const bool completed = run_thesis(chosen, runs, plumbline_commands(arguments.program), options);
  publication.write();
  list_rows(chosen, runs, publication.results());
  std::cout << runs.page().string() << std::endl;
  return completed ? kExitDone : kExitInterrupted;
}

}  // namespace
}  // namespace plumbline

int main(int argc, char** argv) {
  plumbline::Arguments arguments;
  arguments.program = (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "plumbline").string();
  CLI::App app("Runs the thesis's experiments and says which of its claims hold");
  app.add_option("ID", arguments.ids, "experiments; all by default");
  app.add_option("--budget", arguments.budget_min,
                 "minutes: no run starts that is not expected to end within; as long as it takes by default")
      ->check(CLI::PositiveNumber);
  app.add_option("--jobs", arguments.jobs, "runs at a time, one by default")->check(CLI::Range(1, 1024));
  app.add_flag("--list", arguments.list, "say what there is and what it would take, and run nothing");
  app.add_option("--table", arguments.table, "the experiments' file");
  app.add_option("--results", arguments.results, "where results.json is kept");
  app.add_option("--out", arguments.out, "directory for runs and page");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? plumbline::kExitDone : plumbline::kExitBadInput;
  }
  try {
    return plumbline::run(arguments);
  } catch (const plumbline::InputError& error) {
    std::cerr << "thesis_suite: " << error.what() << "\n";
    return plumbline::kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "thesis_suite: " << error.what() << "\n";
    return plumbline::kExitFault;
  }
}
