#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

/// What the commands that make many runs share.
namespace plumbline {

/// --jobs; 0, the default, stands for one per core.
void add_jobs_option(CLI::App& command, int& jobs);
int jobs_or_all(int jobs);

/// Absolute, without a trailing slash.
std::filesystem::path absolute_directory(const std::string& path);

/// An estimator's name as it is, or with the path of an outside estimator (LIBRARY.so, exec:PROGRAM ARGUMENTS) made
/// absolute: for commands that go elsewhere to run it.
std::string estimator_from_anywhere(const std::string& name);

/// The program that runs now, for its child processes.
std::string own_program();

}  // namespace plumbline
