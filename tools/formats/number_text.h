#pragma once

#include <cstdint>
#include <optional>
#include <string>

/// Numbers as text, independent of the locale and fast enough for tens of thousands of poses.
namespace plumbline {

/// Appends with so many digits after the point; a value that is not finite becomes "nan".
void append_fixed(std::string& text, double value, int decimals);

/// Appends with so many significant digits, in whichever notation is shorter.
void append_general(std::string& text, double value, int digits);

/// Appends the shortest text that reads back as the same number.
void append_exact(std::string& text, double value);

/// Appends nanoseconds as seconds with nine decimals, exactly.
void append_seconds(std::string& text, std::int64_t stamp_ns);

/// As append_fixed, as a string of its own.
std::string fixed_text(double value, int decimals);

/// For people: three or so significant digits, without exponents for ordinary sizes; a dash if it is not finite.
std::string readable_text(double value);
/// The same, or a dash where there is no value.
std::string shown(const std::optional<double>& value);

}  // namespace plumbline
