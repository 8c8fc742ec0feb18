#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Lines of numbers as data sets keep them.
namespace plumbline {

/// The words of a line; separators count once however many.
std::vector<std::string_view> split_fields(std::string_view line, std::string_view separators = " \t\r");

/// A word as it may appear in a message: short, printable.
std::string quoted_field(std::string_view word);

/// Empty unless the whole word is one finite number.
std::optional<double> parse_number(std::string_view word);

/// Seconds to nanoseconds: plain decimals exactly, digits past the ninth rounded; exponent notation ("1.3e9"), which no
/// writer means to be exact, through a double. Empty if it is no time within 9e9 s.
std::optional<std::int64_t> parse_stamp(std::string_view word);

}  // namespace plumbline
