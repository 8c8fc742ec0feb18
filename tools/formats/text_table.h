#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

/// Walks a text file of numbers line by line; empty lines and those that begin with '#' are passed over.
class TextTable {
 public:
  /// @throws InputError if the file cannot be read or is larger than 1 GiB
  explicit TextTable(const std::filesystem::path& path, std::string_view separators = " \t\r");

  /// Goes to the next line. @return false at the end @throws InputError for a line longer than 4096 bytes
  bool next();

  std::size_t size() const { return words_.size(); }
  /// The fields of the current line. @throws InputError naming file and line
  std::string_view word(std::size_t column) const;
  double number(std::size_t column) const;
  std::int64_t seconds_as_ns(std::size_t column) const;
  std::int64_t whole(std::size_t column) const;

  [[noreturn]] void reject(const std::string& what) const;

 private:
  std::filesystem::path path_;
  std::string_view separators_;
  std::ifstream stream_;
  std::size_t line_number_ = 0;
  std::string line_;
  std::vector<std::string_view> words_;
};

/// All of a small file. @throws InputError if it cannot be read or is larger than `most_bytes`
std::string read_bounded_file(const std::filesystem::path& path, std::uintmax_t most_bytes);

/// A file that a dataset's own list names: below the list's folder, by a relative path without "..".
/// @throws InputError
std::filesystem::path listed_file(const std::filesystem::path& folder, std::string_view name);

/// The files of a folder whose names are a number and one of some extensions (".png"), by number.
struct NumberedFile {
  std::int64_t number = 0;
  std::filesystem::path path;
};
std::vector<NumberedFile> numbered_files(const std::filesystem::path& folder,
                                         const std::vector<std::string>& extensions);

}  // namespace plumbline
