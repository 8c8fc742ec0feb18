#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace plumbline {

/// A value of a configuration file, with the place it comes from.
struct ConfigNode {
  enum class Kind { kScalar, kSequence, kMap };

  Kind kind = Kind::kScalar;
  std::string text;     ///< of a scalar, as written
  bool quoted = false;  ///< a quoted scalar is a string, whatever it looks like
  std::vector<ConfigNode> items;
  std::map<std::string, ConfigNode> entries;

  std::string where;                ///< "file.yaml:12", or the command-line option
  std::filesystem::path directory;  ///< what relative paths in it are relative to

  bool is_map() const { return kind == Kind::kMap; }
  bool is_sequence() const { return kind == Kind::kSequence; }
  bool is_scalar() const { return kind == Kind::kScalar; }
  bool is_nothing() const { return is_scalar() && text.empty() && !quoted; }
};

/// Lays `over` on `base`: maps are merged key by key, anything else is replaced.
ConfigNode merged(ConfigNode base, const ConfigNode& over);

/// One canonical YAML text per value: block style, keys sorted.
std::string canonical_yaml(const ConfigNode& node);

/// The value on one line, in YAML's flow style, keys sorted: what can stand after the '=' of an override.
std::string flow_yaml(const ConfigNode& node);

/// What a message says of a value that is not what it should be: "'fast'", "a list", "nothing".
std::string described(const ConfigNode& node);

}  // namespace plumbline
