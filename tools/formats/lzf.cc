#include "tools/formats/lzf.h"

#include <stdexcept>

namespace plumbline {
namespace {

constexpr std::size_t kLongestRun = 32;  // a control byte below this is a run of literals, one longer than it says
constexpr std::size_t kExtended = 7;     // a copy's length that goes on in the next byte

[[noreturn]] void damaged() { throw std::invalid_argument("its compressed points are damaged"); }

}  // namespace

std::string unpack_lzf(const std::string& packed, std::size_t size) {
  std::string plain;
  plain.reserve(size);
  std::size_t at = 0;
  const auto next = [&]() -> std::size_t {
    if (at == packed.size()) damaged();
    return static_cast<unsigned char>(packed[at++]);
  };
  while (at < packed.size()) {
    const std::size_t control = next();
    if (control < kLongestRun) {
      const std::size_t length = control + 1;
      if (packed.size() - at < length || size - plain.size() < length) damaged();
      plain.append(packed, at, length);
      at += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == kExtended) length += next();
    length += 2;
    const std::size_t back = ((control & 0x1f) << 8) + next() + 1;
    if (back > plain.size() || size - plain.size() < length) damaged();
    // A copy may overlap what it makes.
    for (std::size_t k = 0; k < length; ++k) plain += plain[plain.size() - back];
  }
  if (plain.size() != size) damaged();
  return plain;
}

}  // namespace plumbline
