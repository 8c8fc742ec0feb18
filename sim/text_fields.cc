#include "sim/text_fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace plumbline {
namespace {

constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // fits int64 nanoseconds

/// "-12.345" to nanoseconds without rounding; digits past the ninth decimal round to nearest.
std::optional<std::int64_t> parse_plain_stamp(std::string_view word) {
  const bool negative = !word.empty() && word.front() == '-';
  if (negative) word.remove_prefix(1);
  const std::size_t point = std::min(word.find('.'), word.size());
  const std::string_view whole = word.substr(0, point);
  const std::string_view fraction = point < word.size() ? word.substr(point + 1) : std::string_view{};
  if (whole.empty() && fraction.empty()) return std::nullopt;

  std::int64_t stamp_ns = 0;
  for (const char c : whole) {
    if (c < '0' || c > '9' || stamp_ns > kMaxSeconds) return std::nullopt;
    stamp_ns = 10 * stamp_ns + (c - '0');
  }
  if (stamp_ns > kMaxSeconds) return std::nullopt;
  for (std::size_t i = 0; i < 9; ++i) {
    const char c = i < fraction.size() ? fraction[i] : '0';
    if (c < '0' || c > '9') return std::nullopt;
    stamp_ns = 10 * stamp_ns + (c - '0');
  }
  for (std::size_t i = 9; i < fraction.size(); ++i) {
    if (fraction[i] < '0' || fraction[i] > '9') return std::nullopt;
  }
  if (fraction.size() > 9 && fraction[9] >= '5') ++stamp_ns;
  return negative ? -stamp_ns : stamp_ns;
}

}  // namespace

std::vector<std::string_view> split_fields(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> words;
  std::size_t at = line.find_first_not_of(separators);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(separators, end);
  }
  return words;
}

std::string quoted_field(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 40)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (word.size() > 40 ? "…'" : "'");
}

std::optional<double> parse_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_stamp(std::string_view word) {
  if (const auto exact = parse_plain_stamp(word)) return exact;
  const auto seconds = parse_number(word);
  if (!seconds || std::abs(*seconds) > static_cast<double>(kMaxSeconds)) return std::nullopt;
  return static_cast<std::int64_t>(std::llround(*seconds * 1e9));
}

}  // namespace plumbline
