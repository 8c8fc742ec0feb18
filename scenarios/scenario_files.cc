#include "scenarios/scenario_files.h"

#include <algorithm>

#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"
#include "scenarios/yaml_reader.h"

namespace plumbline {
namespace {

constexpr std::size_t kMaxBases = 8;

ConfigNode empty_map() {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kMap;
  node.where = "the command line";
  node.directory = std::filesystem::current_path();
  return node;
}

ConfigNode read_with_bases(const std::filesystem::path& path, std::vector<std::filesystem::path>& above) {
  ConfigNode file = read_yaml_file(path);
  if (!file.is_map()) fail_at(file, "the file", "a map of keys");
  ConfigReader reader(file, "");
  std::filesystem::path base;
  if (!reader.read("base", base)) return file;

  const ConfigNode& named = *reader.find("base");
  above.push_back(std::filesystem::canonical(path));
  if (std::find(above.begin(), above.end(), std::filesystem::canonical(base)) != above.end()) {
    fail_at(named, "base", "a file that does not lead back to this one");
  }
  if (above.size() > kMaxBases) fail_at(named, "base", "at most " + std::to_string(kMaxBases) + " bases in a chain");
  ConfigNode result = read_with_bases(base, above);
  file.entries.erase("base");
  return merged(std::move(result), file);
}

std::vector<std::string> split_key(const std::string& key, const std::string& option) {
  std::vector<std::string> parts(1);
  for (const char c : key) {
    const bool is_word = c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (c == '.') {
      parts.emplace_back();
    } else if (is_word) {
      parts.back() += c;
    } else {
      throw InputError(option + ": found the key '" + key + "', expected words joined by dots");
    }
  }
  const bool has_gap = std::any_of(parts.begin(), parts.end(), [](const std::string& part) { return part.empty(); });
  if (has_gap) throw InputError(option + ": found the key '" + key + "', expected words joined by dots");
  if (parts.front() == "base") throw InputError(option + ": base can only be set in a file");
  return parts;
}

/// The map that holds nothing but the override.
ConfigNode read_override(const std::string& override) {
  const std::string option = "--set " + override;
  const std::size_t equals = override.find('=');
  if (equals == std::string::npos) throw InputError(option + ": found no '=', expected KEY=VALUE");
  const std::vector<std::string> parts = split_key(override.substr(0, equals), option);
  ConfigNode node = read_yaml_text(override.substr(equals + 1), option, std::filesystem::current_path());
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    ConfigNode parent;
    parent.kind = ConfigNode::Kind::kMap;
    parent.where = option;
    parent.directory = node.directory;
    parent.entries.emplace(*part, std::move(node));
    node = std::move(parent);
  }
  return node;
}

}  // namespace

ConfigNode read_scenario_files(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  std::vector<std::filesystem::path> above;
  ConfigNode result = path.empty() ? empty_map() : read_with_bases(path, above);
  for (const auto& override : overrides) result = merged(std::move(result), read_override(override));
  return result;
}

}  // namespace plumbline
