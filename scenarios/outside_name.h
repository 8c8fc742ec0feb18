#pragma once

#include <optional>
#include <string>
#include <vector>

namespace plumbline {

/// The name of an estimator that is not built in: "exec:PROGRAM ARGUMENTS...", split at blanks, or a shared library,
/// "PATH.so".
struct OutsideName {
  enum class Kind { kProgram, kLibrary };
  Kind kind = Kind::kProgram;
  std::vector<std::string> words;  ///< program and arguments, or the library's path; may be none

  /// The path among them that a file must stand at; nothing for a program that is looked for in PATH.
  std::optional<std::string> file() const;
};

/// @returns nothing for a name of any other form
std::optional<OutsideName> outside_name(const std::string& name);

}  // namespace plumbline
