#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace plumbline {

/// What the parsed command line asks for; gives the exit code.
using Action = std::function<int()>;

/// Each adds its verb to the program and sets `chosen` when the command line holds it.
void add_calibrate_command(CLI::App& app, Action& chosen);
void add_run_command(CLI::App& app, Action& chosen);
void add_evaluate_command(CLI::App& app, Action& chosen);
void add_host_command(CLI::App& app, Action& chosen);
void add_export_command(CLI::App& app, Action& chosen);
void add_list_command(CLI::App& app, Action& chosen);
void add_mount_command(CLI::App& app, Action& chosen);
void add_merge_command(CLI::App& app, Action& chosen);
void add_merge_maps_command(CLI::App& app, Action& chosen);
void add_replay_command(CLI::App& app, Action& chosen);
void add_regress_command(CLI::App& app, Action& chosen);
void add_report_command(CLI::App& app, Action& chosen);
void add_sweep_command(CLI::App& app, Action& chosen);

}  // namespace plumbline
