#pragma once

#include <filesystem>
#include <string_view>

namespace plumbline {

/// Writes a file that appears whole or not at all. @throws InputError if its place cannot be written to
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

}  // namespace plumbline
