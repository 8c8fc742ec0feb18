#include "tools/study/directory_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "scenarios/input_error.h"

namespace plumbline {
namespace {

constexpr std::chrono::milliseconds kPatience{2000};

}  // namespace

DirectoryLock::DirectoryLock(const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / ".lock";
  // Not inherited: a run that outlives its sweep for a moment must not hold the place.
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw InputError(directory.string() + ": cannot be written to: " + std::strerror(errno));
  // Of a sweep that was killed, a child may hold it until it has become another program.
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  int reason = 0;
  do {
    if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
    reason = errno;
    std::this_thread::sleep_for(kPatience / 40);
  } while (reason == EWOULDBLOCK && std::chrono::steady_clock::now() < deadline);
  close(file_);
  if (reason == EWOULDBLOCK) throw InputError(directory.string() + ": another sweep is writing here");
  throw InputError(directory.string() + ": cannot be locked: " + std::strerror(reason));
}

DirectoryLock::~DirectoryLock() { close(file_); }

}  // namespace plumbline
