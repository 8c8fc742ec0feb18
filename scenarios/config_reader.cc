#include "scenarios/config_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "scenarios/input_error.h"

namespace plumbline {
namespace {

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.10g", value);
  return text;
}

std::string shown(Range range) { return " from " + shown(range.min) + " to " + shown(range.max); }

/// Parses the whole of an unquoted scalar; YAML's leading plus is allowed.
template <typename T>
bool parse_scalar(const ConfigNode& node, T& value) {
  if (!node.is_scalar() || node.quoted || node.text.empty()) return false;
  const char* begin = node.text.data() + (node.text[0] == '+' ? 1 : 0);
  const char* end = node.text.data() + node.text.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end && begin != end;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

void fail_at(const ConfigNode& node, const std::string& key, const std::string& expected) {
  throw InputError(node.where + ": " + key + ": found " + described(node) + ", expected " + expected);
}

double number_of(const ConfigNode& node, const std::string& key, Range range) {
  double value = 0.0;
  // from_chars also takes "nan" and "inf"; neither is within a range.
  if (!parse_scalar(node, value) || !(value >= range.min && value <= range.max)) {
    fail_at(node, key, "a number" + shown(range));
  }
  return value;
}

std::int64_t integer_of(const ConfigNode& node, const std::string& key, Range range) {
  std::int64_t value = 0;
  if (!parse_scalar(node, value) || static_cast<double>(value) < range.min || static_cast<double>(value) > range.max) {
    fail_at(node, key, "a whole number" + shown(range));
  }
  return value;
}

const std::string& text_of(const ConfigNode& node, const std::string& key) {
  if (!node.is_scalar() || node.text.empty()) fail_at(node, key, "a word");
  return node.text;
}

const std::vector<ConfigNode>& list_of(const ConfigNode& node, const std::string& key) {
  if (!node.is_sequence()) fail_at(node, key, "a list");
  return node.items;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    const bool left_out_unit = candidate.starts_with(std::string(word) + "_");
    const std::size_t distance = left_out_unit ? 0 : edit_distance(word.substr(0, 100), candidate);
    if (distance < best_distance || (distance == best_distance && candidate.size() < best.size())) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

ConfigReader::ConfigReader(const ConfigNode& map, std::string key) : map_(map), key_(std::move(key)) {
  if (!map.is_map()) fail_at(map, key_.empty() ? "the file" : key_, "a map of keys");
}

const ConfigNode* ConfigReader::find(const std::string& key) {
  known_.insert(key);
  const auto found = map_.entries.find(key);
  return found == map_.entries.end() ? nullptr : &found->second;
}

bool ConfigReader::read(const std::string& key, double& value, Range range) {
  const ConfigNode* node = find(key);
  if (node != nullptr) value = number_of(*node, path_of(key), range);
  return node != nullptr;
}

bool ConfigReader::read(const std::string& key, int& value, Range range) {
  const ConfigNode* node = find(key);
  if (node != nullptr) value = static_cast<int>(integer_of(*node, path_of(key), range));
  return node != nullptr;
}

bool ConfigReader::read(const std::string& key, std::uint64_t& value) {
  const ConfigNode* node = find(key);
  if (node != nullptr && !parse_scalar(*node, value)) {
    fail_at(*node, path_of(key), "a whole number from 0 to 18446744073709551615");
  }
  return node != nullptr;
}

bool ConfigReader::read(const std::string& key, bool& value) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return false;
  const bool is_word = node->is_scalar() && !node->quoted;
  if (!is_word || (node->text != "true" && node->text != "false")) fail_at(*node, path_of(key), "true or false");
  value = node->text == "true";
  return true;
}

bool ConfigReader::read(const std::string& key, std::string& value) {
  const ConfigNode* node = find(key);
  if (node != nullptr) value = text_of(*node, path_of(key));
  return node != nullptr;
}

bool ConfigReader::read(const std::string& key, std::vector<double>& values, Range range) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return false;
  values.clear();
  for (const auto& item : list_of(*node, path_of(key))) values.push_back(number_of(item, path_of(key), range));
  return true;
}

bool ConfigReader::read(const std::string& key, std::filesystem::path& value) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return false;
  value = (node->directory / text_of(*node, path_of(key))).lexically_normal();
  std::error_code error;
  if (!std::filesystem::is_regular_file(value, error)) {
    fail_at(*node, path_of(key), "an existing file (looked for " + value.string() + ")");
  }
  return true;
}

bool ConfigReader::read_choice(const std::string& key, const std::vector<std::string>& words, std::size_t& index) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return false;
  const auto found = node->is_scalar() ? std::find(words.begin(), words.end(), node->text) : words.end();
  if (found == words.end()) fail_at(*node, path_of(key), "one of: " + joined(words));
  index = static_cast<std::size_t>(found - words.begin());
  return true;
}

bool ConfigReader::section(const std::string& key, const std::function<void(ConfigReader&)>& read_keys) {
  const ConfigNode* node = find(key);
  if (node == nullptr) return false;
  ConfigReader below(*node, path_of(key));
  read_keys(below);
  below.finish();
  return true;
}

void ConfigReader::finish() const {
  const std::vector<std::string> allowed(known_.begin(), known_.end());
  for (const auto& [key, value] : map_.entries) {
    if (known_.contains(key)) continue;
    const std::string guess = nearest(key, allowed);
    throw InputError(value.where + ": " + path_of(key) + ": unknown key" +
                     (guess.empty() ? "" : ", did you mean '" + path_of(guess) + "'?") +
                     " (allowed here: " + joined(allowed) + ")");
  }
}

}  // namespace plumbline
