#include "tools/output/provenance.h"

#include <sys/utsname.h>

#include <fstream>
#include <iterator>
#include <thread>

#include "scenarios/digest.h"
#include "scenarios/input_error.h"
#include "tools/output/build_info.h"

namespace plumbline {
namespace {

/// The value of the first "key<separator>value" line of a system file, without quotes; empty when there is none.
std::string value_in(const char* path, const std::string& key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, key.size(), key) != 0) continue;
    const auto at = line.find(separator);
    if (at == std::string::npos) continue;
    const auto start = line.find_first_not_of(" \t\"", at + 1);
    if (start == std::string::npos) return {};
    return line.substr(start, line.find_last_not_of(" \t\"") - start + 1);
  }
  return {};
}

std::string operating_system() {
  std::string text = value_in("/etc/os-release", "PRETTY_NAME", '=');
  utsname system{};
  if (uname(&system) == 0) {
    if (!text.empty()) text += ", ";
    text += std::string(system.sysname) + " " + system.release + " " + system.machine;
  }
  return text;
}

}  // namespace

Machine this_machine() {
  return {value_in("/proc/cpuinfo", "model name", ':'), std::thread::hardware_concurrency(), operating_system()};
}

std::string program_version() {
  const std::string commit = kGitCommit;
  return kVersion + (commit.empty() ? std::string() : " (" + commit + ")");
}

std::string program_identity(const std::filesystem::path& program) {
  std::ifstream file(program, std::ios::binary);
  if (!file) throw InputError(program.string() + ": cannot be read, expected a program");
  return program_version() + " " + digest_of(std::string{std::istreambuf_iterator<char>(file), {}}).substr(0, 8);
}

Provenance make_provenance(const Scenario& scenario, int threads) {
  Provenance provenance;
  provenance.version = kVersion;
  provenance.git_commit = kGitCommit;
  provenance.scenario = scenario.name;
  provenance.scenario_path = scenario.path.string();
  provenance.scenario_digest = scenario.digest;
  provenance.seed = scenario.seed;
  provenance.estimator = scenario.estimator_name;
  provenance.threads = threads;
  provenance.machine = this_machine();
  return provenance;
}

std::vector<std::pair<std::string, std::string>> provenance_rows(const Provenance& p) {
  return {
      {"Plumbline", p.version + (p.git_commit.empty() ? "" : " (" + p.git_commit + ")")},
      {"Scenario", p.scenario_path},
      {"Digest", p.scenario_digest},
      {"Seed", std::to_string(p.seed)},
      {"Estimator", p.estimator},
      {"Threads", std::to_string(p.threads)},
      {"Processor", p.machine.cpu + ", " + std::to_string(p.machine.cores) + " cores"},
      {"System", p.machine.os},
  };
}

}  // namespace plumbline
