#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/config_node.h"

namespace plumbline {

/// Bounds of a number, both allowed.
struct Range {
  double min = 0.0;
  double max = 0.0;
};

inline constexpr Range kRunTime_s{0.0, 100'000.0};  ///< of a run

/// Throws an InputError: "WHERE: KEY: found FOUND, expected EXPECTED".
[[noreturn]] void fail_at(const ConfigNode& node, const std::string& key, const std::string& expected);

/// Scalars, strictly: the whole text must be of the type, finite and within the range. `key` is for the message.
double number_of(const ConfigNode& node, const std::string& key, Range range);
std::int64_t integer_of(const ConfigNode& node, const std::string& key, Range range);
const std::string& text_of(const ConfigNode& node, const std::string& key);
const std::vector<ConfigNode>& list_of(const ConfigNode& node, const std::string& key);

/// The candidate that a misspelt word most likely means, or nothing.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);
/// "a, b, c".
std::string joined(const std::vector<std::string>& words);

/// Reads the keys of one map into fields that hold the defaults. Keys that nobody asked for are an error, so what is
/// read is what is allowed.
class ConfigReader {
 public:
  /// @param key  path of the map, empty for the whole file
  ConfigReader(const ConfigNode& map, std::string key);

  /// Each returns whether the key is there.
  bool read(const std::string& key, double& value, Range range);
  bool read(const std::string& key, int& value, Range range);
  bool read(const std::string& key, std::uint64_t& value);
  bool read(const std::string& key, bool& value);
  bool read(const std::string& key, std::string& value);
  bool read(const std::string& key, std::vector<double>& values, Range range);
  /// An existing file; relative paths are relative to the file that sets the key.
  bool read(const std::string& key, std::filesystem::path& value);
  /// One of some words, as its index.
  bool read_choice(const std::string& key, const std::vector<std::string>& words, std::size_t& index);
  /// A map below, which `read_keys` reads to the full.
  bool section(const std::string& key, const std::function<void(ConfigReader&)>& read_keys);

  /// The value of a key, which counts as read, or nullptr.
  const ConfigNode* find(const std::string& key);

  const std::string& path() const { return key_; }
  std::string path_of(const std::string& key) const { return key_.empty() ? key : key_ + "." + key; }
  const ConfigNode& node() const { return map_; }
  /// @throws InputError if a key was not read.
  void finish() const;

 private:
  const ConfigNode& map_;
  std::string key_;
  std::set<std::string> known_;
};

}  // namespace plumbline
