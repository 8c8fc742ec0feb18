#include "tools/study/slurm_array.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "scenarios/input_error.h"
#include "tools/interrupt.h"
#include "tools/study/child_process.h"

namespace plumbline {
namespace {

constexpr RunLimits kCommandLimits{600.0, 4096.0};
constexpr int kAttempts = 30;
constexpr std::chrono::seconds kBetweenAttempts{10};

ChildEnd run_command(const std::vector<std::string>& command) {
  ChildProcess process(command, kCommandLimits);
  for (;;) {
    if (auto end = process.poll()) return *end;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

bool succeeded(const ChildEnd& end) { return end.kind == ChildEnd::Kind::kExited && end.code == 0; }

[[noreturn]] void fail(const std::string& command, const ChildEnd& end) {
  std::string said = end.output;
  while (said.ends_with('\n')) said.pop_back();
  if (end.kind == ChildEnd::Kind::kTimeLimit) said += " (no answer within ten minutes)";
  throw InputError("--launcher slurm: " + command + " failed: " + (said.empty() ? "it says nothing" : said));
}

/// "123" or "123;cluster" among warnings.
std::string job_in(const std::string& output) {
  std::string job;
  std::size_t start = 0;
  while (start < output.size()) {
    const std::size_t end = std::min(output.find('\n', start), output.size());
    const std::string line = output.substr(start, end - start);
    const std::string digits = line.substr(0, line.find(';'));
    if (!digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos) job = digits;
    start = end + 1;
  }
  return job;
}

}  // namespace

std::string index_ranges(const std::vector<std::size_t>& indices) {
  std::string text;
  for (std::size_t first = 0; first < indices.size();) {
    std::size_t last = first;
    while (last + 1 < indices.size() && indices[last + 1] == indices[last] + 1) ++last;
    if (!text.empty()) text += ',';
    text += std::to_string(indices[first]);
    if (last > first) text += '-' + std::to_string(indices[last]);
    first = last + 1;
  }
  return text;
}

void require_slurm() {
  const ChildEnd end = run_command({"sbatch", "--version"});
  if (!succeeded(end)) fail("sbatch", end);
}

std::string submit(const SlurmArray& array) {
  const ChildEnd end = run_command(
      {"sbatch", "--parsable", "--job-name=" + array.name, "--array=" + index_ranges(array.indices), "--ntasks=1",
       "--cpus-per-task=1", "--open-mode=append", "--output=" + array.log_pattern.string(), array.script.string()});
  const std::string job = job_in(end.output);
  if (!succeeded(end) || job.empty()) fail("sbatch", end);
  return job;
}

bool is_queued(const std::string& job) {
  for (int attempt = 1;; ++attempt) {
    const ChildEnd end = run_command({"squeue", "--noheader", "--format=%i", "--jobs=" + job});
    if (succeeded(end)) return end.output.find_first_not_of(" \n") != std::string::npos;
    // What ended some minutes ago is forgotten.
    if (end.output.find("Invalid job id") != std::string::npos) return false;
    if (attempt == kAttempts || interrupted()) fail("squeue", end);
    std::this_thread::sleep_for(kBetweenAttempts);
  }
}

void cancel(const std::string& job) { run_command({"scancel", job}); }

}  // namespace plumbline
