#pragma once

#include <filesystem>

namespace plumbline {

/// A study's directory held by one process. The lock dies with the process, however that dies; its file stays.
class DirectoryLock {
 public:
  /// @param directory  exists
  /// @throws InputError if another process holds it or the lock's file cannot be made
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace plumbline
