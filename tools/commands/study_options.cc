#include "tools/commands/study_options.h"

#include <algorithm>
#include <thread>

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxJobs = 1024;

}  // namespace

void add_jobs_option(CLI::App& command, int& jobs) {
  command.add_option("--jobs", jobs, "runs at a time; one per core by default; the results are the same")
      ->check(CLI::Range(1, kMaxJobs));
}

int jobs_or_all(int jobs) {
  return jobs > 0 ? jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

fs::path absolute_directory(const std::string& path) {
  const fs::path normal = fs::absolute(path).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

std::string estimator_from_anywhere(const std::string& name) {
  constexpr std::string_view kProgram = "exec:";
  const std::size_t start = name.starts_with(kProgram) ? kProgram.size() : 0;
  const std::size_t end = start > 0 ? std::min(name.find(' ', start), name.size()) : name.size();
  const std::string word = name.substr(start, end - start);
  if (word.find('/') == std::string::npos && !name.ends_with(".so")) return name;
  return name.substr(0, start) + fs::absolute(word).lexically_normal().string() + name.substr(end);
}

std::string own_program() { return fs::read_symlink("/proc/self/exe").string(); }

}  // namespace plumbline
