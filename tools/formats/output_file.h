#pragma once

#include <filesystem>
#include <fstream>
#include <string_view>

namespace plumbline {

/// A file that is written bit by bit; every failure is noticed.
class OutputFile {
 public:
  /// @throws std::runtime_error if it cannot be made
  explicit OutputFile(const std::filesystem::path& path);

  /// @throws std::runtime_error if not all was taken
  void write(std::string_view content);
  void close();

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
};

/// A whole file at once. @throws std::runtime_error
void write_whole_file(const std::filesystem::path& path, std::string_view content);

}  // namespace plumbline
