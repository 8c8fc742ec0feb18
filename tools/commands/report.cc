#include "tools/commands/report.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include "scenarios/input_error.h"
#include "tools/commands/command.h"
#include "tools/exit_code.h"
#include "tools/study/sweep_directory.h"
#include "tools/study/sweep_outputs.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// A run's page holds camera frames that no other file keeps: it is what the run itself wrote.
int show_page_of_run(const fs::path& page) {
  if (!fs::is_regular_file(page)) throw InputError(page.string() + ": missing; only the run itself can write it");
  std::cout << "  report      " << page.string() << std::endl;
  return kExitDone;
}

}  // namespace

int remake_report(const std::string& directory) {
  const fs::path root(directory);
  const fs::path page = root / "report.html";
  if (fs::is_regular_file(root / "result.json")) return show_page_of_run(page);
  const StoredSweep sweep = read_sweep(root);
  write_sweep_outputs(root, sweep.plan, run_rows(sweep.plan, sweep.runs));
  std::cout << sweep.plan.name << ": " << sweep.runs.size() << " of " << sweep.plan.runs.size() << " runs\n"
            << "  report      " << page.string() << std::endl;
  return kExitDone;
}

void add_report_command(CLI::App& app, Action& chosen) {
  const auto directory = std::make_shared<std::string>();
  CLI::App* report = app.add_subcommand("report", "Make the page, charts and tables of a sweep's directory anew");
  report->add_option("DIR", *directory, "directory of a sweep, or of a run, whose page is then shown")->required();
  report->callback([directory, &chosen] { chosen = [directory] { return remake_report(*directory); }; });
}

}  // namespace plumbline
