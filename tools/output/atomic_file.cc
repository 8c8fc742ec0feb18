#include "tools/output/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "scenarios/scenario.h"

namespace plumbline {

void write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path staging = path;
  staging += ".partial-" + std::to_string(getpid());
  std::ofstream file(staging, std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  std::error_code error;
  if (file) {
    std::filesystem::rename(staging, path, error);
    if (!error) return;
  }
  const std::string reason = error ? error.message() : std::strerror(errno);
  std::filesystem::remove(staging, error);
  throw InputError(path.string() + ": cannot be written: " + reason);
}

}  // namespace plumbline
