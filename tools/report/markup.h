#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

/// Text made safe for HTML and SVG, in elements and in quoted attributes alike.
std::string escape_markup(std::string_view text);

/// A picture as a data: address, so that a page needs no second file.
std::string png_data_address(const std::vector<std::uint8_t>& png);

}  // namespace plumbline
