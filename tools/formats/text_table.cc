#include "tools/formats/text_table.h"

#include <algorithm>
#include <charconv>

#include "scenarios/input_error.h"
#include "sim/text_fields.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostTableBytes = std::uintmax_t{1} << 30;
constexpr std::size_t kMostLineBytes = 4096;
constexpr std::size_t kMostFiles = 10'000'000;

std::uintmax_t size_of(const fs::path& path, std::uintmax_t most_bytes) {
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(path.string() + ": no such file");
  if (!fs::is_regular_file(path, error)) throw InputError(path.string() + ": not a regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size > most_bytes) {
    throw InputError(path.string() + ": found " + std::to_string(size) + " bytes, allowed are " +
                     std::to_string(most_bytes));
  }
  return size;
}

std::optional<std::int64_t> parse_whole(std::string_view word) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

TextTable::TextTable(const fs::path& path, std::string_view separators) : path_(path), separators_(separators) {
  size_of(path, kMostTableBytes);
  stream_.open(path, std::ios::binary);
  if (!stream_) throw InputError(path.string() + ": cannot be read");
}

bool TextTable::next() {
  while (std::getline(stream_, line_)) {
    ++line_number_;
    if (line_.size() > kMostLineBytes) reject("the line is longer than " + std::to_string(kMostLineBytes) + " bytes");
    words_ = split_fields(line_, separators_);
    if (!words_.empty() && words_.front().front() != '#') return true;
  }
  return false;
}

std::string_view TextTable::word(std::size_t column) const {
  if (column < words_.size()) return words_[column];
  reject("found " + std::to_string(words_.size()) + " values, expected at least " + std::to_string(column + 1));
}

double TextTable::number(std::size_t column) const {
  if (const auto value = parse_number(word(column))) return *value;
  reject(quoted_field(word(column)) + " is not a finite number");
}

std::int64_t TextTable::seconds_as_ns(std::size_t column) const {
  if (const auto stamp_ns = parse_stamp(word(column))) return *stamp_ns;
  reject(quoted_field(word(column)) + " is not a time in seconds below 9e9");
}

std::int64_t TextTable::whole(std::size_t column) const {
  if (const auto value = parse_whole(word(column))) return *value;
  reject(quoted_field(word(column)) + " is not a whole number");
}

void TextTable::reject(const std::string& what) const {
  throw InputError(path_.string() + ":" + std::to_string(line_number_) + ": " + what);
}

std::string read_bounded_file(const fs::path& path, std::uintmax_t most_bytes) {
  std::string bytes(size_of(path, most_bytes), '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw InputError(path.string() + ": cannot be read");
  return bytes;
}

fs::path listed_file(const fs::path& folder, std::string_view name) {
  const fs::path file(name);
  const bool leads_out =
      file.is_absolute() || std::any_of(file.begin(), file.end(), [](const fs::path& part) { return part == ".."; });
  if (leads_out || file.empty()) {
    throw InputError(folder.string() + ": its list names " + quoted_field(name) +
                     ", expected a path within the dataset");
  }
  return folder / file;
}

std::vector<NumberedFile> numbered_files(const fs::path& folder, const std::vector<std::string>& extensions) {
  std::vector<NumberedFile> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& path = entry->path();
    if (std::find(extensions.begin(), extensions.end(), path.extension()) == extensions.end()) continue;
    const auto number = parse_whole(path.stem().string());
    if (!number || *number < 0) continue;
    if (files.size() == kMostFiles) throw InputError(folder.string() + ": more than 10 million files");
    files.push_back({*number, path});
  }
  std::sort(files.begin(), files.end(),
            [](const auto& a, const auto& b) { return a.number != b.number ? a.number < b.number : a.path < b.path; });
  return files;
}

}  // namespace plumbline
