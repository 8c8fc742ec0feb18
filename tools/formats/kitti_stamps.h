#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace plumbline {

/// A list of times, one a line: seconds, or KITTI raw's "2011-09-26 13:02:25.951199337", since 1970. @throws InputError
std::vector<std::int64_t> read_kitti_stamps(const std::filesystem::path& path);

}  // namespace plumbline
