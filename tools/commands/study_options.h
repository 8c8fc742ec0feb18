#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

/// What the commands that make many runs have in common.
namespace plumbline {

/// Adds --jobs. @param jobs  stays 0 where it is not given
void add_jobs_option(CLI::App& command, int& jobs);
/// As asked for, or one per core.
int jobs_or_cores(int jobs);

/// Without a trailing slash, so that it has a name.
std::filesystem::path absolute_directory(const std::string& path);

}  // namespace plumbline
