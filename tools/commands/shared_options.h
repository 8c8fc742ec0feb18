#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

/// Options that several verbs take.
namespace plumbline {

/// A whole number from 0: CLI11 by itself wraps negative ones around when it reads an unsigned one.
CLI::Validator whole_number();

/// --set KEY=VALUE, any number of times.
void add_set_option(CLI::App& verb, std::vector<std::string>& overrides, const std::string& help);

/// --threads N.
void add_threads_option(CLI::App& verb, int& threads);

/// What --threads asked for; 0: as many as the machine has.
int threads_of(int asked);

}  // namespace plumbline
