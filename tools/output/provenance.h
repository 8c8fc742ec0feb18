#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"

namespace plumbline {

struct Machine {
  std::string cpu;
  unsigned cores = 0;
  std::string os;
};

/// What a figure must be seen with to mean something later.
struct Provenance {
  std::string version;
  std::string git_commit;  ///< empty when unknown
  std::string scenario;
  std::string scenario_path;
  std::string scenario_digest;
  std::uint64_t seed = 0;
  std::string estimator;
  int threads = 0;
  Machine machine;
};

Machine this_machine();

/// "0.1.0 (7c7af71)": the version, and the commit where it is known.
std::string program_version();

/// "0.1.0 (7c7af71) 1a2b3c4d": that, and what the program's file really is: it may be built from what is in no commit.
/// @throws InputError if it cannot be read
std::string program_identity(const std::filesystem::path& program);

Provenance make_provenance(const Scenario& scenario, int threads);

/// For tables: what it is called, and what it is.
std::vector<std::pair<std::string, std::string>> provenance_rows(const Provenance& provenance);

}  // namespace plumbline
