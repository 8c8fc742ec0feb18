#include "tools/formats/output_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace plumbline {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path) : path_(path), stream_(path, std::ios::binary) {
  if (!stream_) fail(path_);
}

void OutputFile::write(std::string_view content) {
  stream_.write(content.data(), static_cast<std::streamsize>(content.size()));
  if (!stream_) fail(path_);
}

void OutputFile::close() {
  stream_.close();
  if (!stream_) fail(path_);
}

void write_whole_file(const std::filesystem::path& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.close();
}

}  // namespace plumbline
