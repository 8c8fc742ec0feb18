#include "tools/study/directory_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "scenarios/input_error.h"

namespace plumbline {

DirectoryLock::DirectoryLock(const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / ".lock";
  // Not inherited: a run that outlives its sweep for a moment must not hold the place.
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw InputError(directory.string() + ": cannot be written to: " + std::strerror(errno));
  if (flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  close(file_);
  if (reason == EWOULDBLOCK) throw InputError(directory.string() + ": another sweep is writing here");
  throw InputError(directory.string() + ": cannot be locked: " + std::strerror(reason));
}

DirectoryLock::~DirectoryLock() { close(file_); }

}  // namespace plumbline
