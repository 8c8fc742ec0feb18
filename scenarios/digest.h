#pragma once

#include <string>
#include <string_view>

namespace plumbline {

/// FNV-1a, 64 bits, as 16 hexadecimal digits: stable over machines and years, which is all that provenance asks.
std::string digest_of(std::string_view text);

}  // namespace plumbline
