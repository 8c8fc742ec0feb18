#include "scenarios/outside_name.h"

#include <sstream>

namespace plumbline {

std::optional<std::string> OutsideName::file() const {
  if (words.empty()) return std::nullopt;
  const bool is_path = kind == Kind::kLibrary || words.front().find('/') != std::string::npos;
  return is_path ? std::optional(words.front()) : std::nullopt;
}

std::optional<OutsideName> outside_name(const std::string& name) {
  constexpr const char* kProgramPrefix = "exec:";
  if (name.ends_with(".so") && !name.starts_with(kProgramPrefix)) {
    return OutsideName{OutsideName::Kind::kLibrary, {name}};
  }
  if (!name.starts_with(kProgramPrefix)) return std::nullopt;
  OutsideName outside;
  std::istringstream command(name.substr(std::string(kProgramPrefix).size()));
  for (std::string word; command >> word;) outside.words.push_back(word);
  return outside;
}

}  // namespace plumbline
