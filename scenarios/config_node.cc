#include "scenarios/config_node.h"

namespace plumbline {
namespace {

std::string scalar_yaml(const ConfigNode& node) {
  if (node.is_nothing()) return "~";
  if (!node.quoted && node.text.find('\n') == std::string::npos) return node.text;
  std::string quoted = "\"";
  for (const char c : node.text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c == '\n') {
      quoted += "\\n";
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

/// Writes what follows "key:" or "-".
void append_value(const ConfigNode& node, int indent, std::string& out) {
  const std::string margin(static_cast<std::size_t>(indent), ' ');
  if (node.is_map() && !node.entries.empty()) {
    for (const auto& [key, value] : node.entries) {
      out += '\n' + margin + key + ':';
      append_value(value, indent + 2, out);
    }
  } else if (node.is_sequence() && !node.items.empty()) {
    for (const auto& item : node.items) {
      out += '\n' + margin + '-';
      append_value(item, indent + 2, out);
    }
  } else if (node.is_map()) {
    out += " {}";
  } else if (node.is_sequence()) {
    out += " []";
  } else {
    out += ' ' + scalar_yaml(node);
  }
}

}  // namespace

ConfigNode merged(ConfigNode base, const ConfigNode& over) {
  if (!base.is_map() || !over.is_map()) return over;
  for (const auto& [key, value] : over.entries) {
    const auto found = base.entries.find(key);
    if (found == base.entries.end()) {
      base.entries.emplace(key, value);
    } else {
      found->second = merged(std::move(found->second), value);
    }
  }
  return base;
}

std::string canonical_yaml(const ConfigNode& node) {
  std::string out;
  append_value(node, 0, out);
  return out.erase(0, 1) + '\n';
}

std::string flow_yaml(const ConfigNode& node) {
  std::string out;
  if (node.is_map()) {
    for (const auto& [key, value] : node.entries) {
      out += out.empty() ? "" : ", ";
      out += key + ": " + flow_yaml(value);
    }
    return out.insert(0, 1, '{') + '}';
  }
  if (node.is_sequence()) {
    for (const auto& item : node.items) {
      out += out.empty() ? "" : ", ";
      out += flow_yaml(item);
    }
    return out.insert(0, 1, '[') + ']';
  }
  ConfigNode scalar = node;
  // A word may hold what would end it in flow style; no number or truth value does.
  scalar.quoted = node.quoted || node.text.find_first_of(",[]{}:#\n") != std::string::npos;
  return scalar_yaml(scalar);
}

std::string described(const ConfigNode& node) {
  constexpr std::size_t kLongest = 60;
  if (node.is_map()) return "a map of keys";
  if (node.is_sequence()) return "a list";
  if (node.is_nothing()) return "nothing";
  const std::string shown = node.text.size() > kLongest ? node.text.substr(0, kLongest) + "..." : node.text;
  return node.quoted ? "the string '" + shown + "'" : "'" + shown + "'";
}

}  // namespace plumbline
