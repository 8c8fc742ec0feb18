#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "scenarios/scenario.h"
#include "tools/commands/command.h"
#include "tools/exit_code.h"
#include "tools/output/provenance.h"

namespace plumbline {
namespace {

int complain(const std::string& what, ExitCode code) {
  std::cerr << "plumbline: " << what << std::endl;
  return code;
}

int run_program(int argc, char** argv) {
  CLI::App app("A proving ground for lidar-visual-inertial odometry", "plumbline");
  app.set_version_flag("--version", program_version());
  app.require_subcommand(1);
  Action chosen;
  add_calibrate_command(app, chosen);
  add_run_command(app, chosen);
  add_evaluate_command(app, chosen);
  add_host_command(app, chosen);
  add_export_command(app, chosen);
  add_list_command(app, chosen);
  add_merge_command(app, chosen);
  add_merge_maps_command(app, chosen);
  add_mount_command(app, chosen);
  add_replay_command(app, chosen);
  add_regress_command(app, chosen);
  add_report_command(app, chosen);
  add_sweep_command(app, chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return complain(error.what(), kExitBadInput);
  }
  return chosen();
}

}  // namespace
}  // namespace plumbline

int main(int argc, char** argv) {
  try {
    return plumbline::run_program(argc, argv);
  } catch (const plumbline::InputError& error) {
    return plumbline::complain(error.what(), plumbline::kExitBadInput);
  } catch (const std::exception& error) {
    return plumbline::complain(std::string("fault: ") + error.what(), plumbline::kExitFault);
  }
}
