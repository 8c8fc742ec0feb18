#include "tools/formats/number_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace plumbline {
namespace {

// Enough for any double in fixed notation with the few decimals asked for here.
constexpr std::size_t kBufferSize = 400;

void append_formatted(std::string& text, double value, std::chars_format format, int precision) {
  if (!std::isfinite(value)) {
    text += "nan";
    return;
  }
  std::array<char, kBufferSize> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, precision).ptr;
  text.append(buffer.data(), end);
}

}  // namespace

void append_fixed(std::string& text, double value, int decimals) {
  append_formatted(text, value, std::chars_format::fixed, decimals);
}

void append_general(std::string& text, double value, int digits) {
  append_formatted(text, value, std::chars_format::general, digits);
}

void append_exact(std::string& text, double value) {
  if (!std::isfinite(value)) {
    text += "nan";
    return;
  }
  std::array<char, kBufferSize> buffer{};
  text.append(buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr);
}

void append_seconds(std::string& text, std::int64_t stamp_ns) {
  constexpr std::uint64_t kNanosecondsPerSecond = 1'000'000'000;
  if (stamp_ns < 0) text += '-';
  const auto magnitude =
      stamp_ns < 0 ? ~static_cast<std::uint64_t>(stamp_ns) + 1 : static_cast<std::uint64_t>(stamp_ns);
  text += std::to_string(magnitude / kNanosecondsPerSecond);
  const std::string fraction = std::to_string(magnitude % kNanosecondsPerSecond);
  text += '.';
  text.append(9 - fraction.size(), '0');
  text += fraction;
}

std::string fixed_text(double value, int decimals) {
  std::string text;
  append_fixed(text, value, decimals);
  return text;
}

std::string readable_text(double value) {
  if (!std::isfinite(value)) return "–";
  const double magnitude = std::abs(value);
  if (magnitude >= 1e6 || (magnitude > 0.0 && magnitude < 1e-4)) {
    std::string text;
    append_general(text, value, 3);
    return text;
  }
  if (magnitude < 1e-4) return "0";
  const int leading = static_cast<int>(std::floor(std::log10(magnitude)));
  return fixed_text(value, std::clamp(2 - leading, 0, 6));
}

std::string shown(const std::optional<double>& value) { return value ? readable_text(*value) : "–"; }

}  // namespace plumbline
