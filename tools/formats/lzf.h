#pragma once

#include <cstddef>
#include <string>

namespace plumbline {

/// Unpacks LZF, with which PCD files are compressed: literals, and copies of what was unpacked before.
/// @param size  of the unpacked data
/// @throws std::invalid_argument if the data are damaged or give another size
std::string unpack_lzf(const std::string& packed, std::size_t size);

}  // namespace plumbline
