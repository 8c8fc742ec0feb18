#include "tools/commands/study_options.h"

#include <algorithm>
#include <thread>

namespace plumbline {

void add_jobs_option(CLI::App& command, int& jobs) {
  constexpr int kMaxJobs = 1024;
  command.add_option("--jobs", jobs, "runs at a time; one per core by default; the results are the same")
      ->check(CLI::Range(1, kMaxJobs));
}

int jobs_or_cores(int jobs) {
  return jobs > 0 ? jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::filesystem::path absolute_directory(const std::string& path) {
  const std::filesystem::path normal = std::filesystem::absolute(path).lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

}  // namespace plumbline
