#pragma once

#include <filesystem>
#include <string_view>

namespace plumbline {

/// A directory that appears whole or not at all: files are written into a hidden sibling that takes its place at the
/// end. A directory of the same kind that was there before, recognised by a file of it, is replaced whole.
class RunDirectory {
 public:
  /// Touches nothing on disk.
  /// @param mark  the file that every directory of the kind holds
  /// @throws InputError if `target` exists and is neither of the kind nor empty
  explicit RunDirectory(const std::filesystem::path& target, const std::string& mark = "result.json");
  ~RunDirectory();
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  /// Makes the hidden sibling, and the target's parents. @throws InputError if that is not permitted
  void open();
  /// @throws std::runtime_error if the file cannot be written whole
  void write(const std::string& name, std::string_view content) const;
  /// Where to write a file that another library writes.
  std::filesystem::path staged(const std::string& name) const { return staging_ / name; }
  /// Puts the directory into place. @throws std::runtime_error
  void commit();

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& staging() const { return staging_; }

 private:
  std::string mark_;
  std::filesystem::path target_;
  std::filesystem::path staging_;
  bool open_ = false;
};

}  // namespace plumbline
