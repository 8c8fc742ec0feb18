#include "tools/output/run_directory.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "scenarios/scenario.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// Absolute and through symbolic links, so that the sibling lies on the same file system and a link stays a link.
fs::path resolved(const fs::path& path) {
  fs::path normal = fs::weakly_canonical(fs::absolute(path));
  return normal.has_filename() ? normal : normal.parent_path();
}

fs::path hidden_sibling(const fs::path& target) {
  std::string name(1, '.');
  name.append(target.filename().string()).append(".partial-").append(std::to_string(getpid()));
  return target.parent_path() / name;
}

void require_replaceable(const fs::path& target, const std::string& mark) {
  std::error_code error;
  if (!fs::exists(target, error)) return;
  if (!fs::is_directory(target, error)) {
    throw InputError("--out " + target.string() + ": exists and is not a directory");
  }
  if (fs::is_empty(target, error) && !error) return;
  if (!fs::is_regular_file(target / mark, error)) {
    throw InputError("--out " + target.string() + ": the directory is not empty and holds no " + mark +
                     "; only a directory of the same kind is replaced");
  }
}

}  // namespace

RunDirectory::RunDirectory(const fs::path& target, const std::string& mark)
    : mark_(mark), target_(resolved(target)), staging_(hidden_sibling(target_)) {
  require_replaceable(target_, mark_);
}

RunDirectory::~RunDirectory() {
  std::error_code ignored;
  if (open_) fs::remove_all(staging_, ignored);
}

void RunDirectory::open() {
  std::error_code error;
  fs::create_directories(target_.parent_path(), error);
  if (!error) fs::create_directory(staging_, error);
  if (error) throw InputError("--out " + target_.string() + ": cannot be created: " + error.message());
  open_ = true;
}

void RunDirectory::write(const std::string& name, std::string_view content) const {
  std::ofstream file(staged(name), std::ios::binary);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) throw std::runtime_error(staged(name).string() + ": cannot be written: " + std::strerror(errno));
}

void RunDirectory::commit() {
  // Exchanged in one step with what stands there; what stood there is then removed with the sibling.
  if (renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0) return;
  if (errno != ENOENT) {
    // A file system that cannot exchange: the old run goes first.
    require_replaceable(target_, mark_);
    fs::remove_all(target_);
  }
  fs::rename(staging_, target_);
  open_ = false;
}

}  // namespace plumbline
