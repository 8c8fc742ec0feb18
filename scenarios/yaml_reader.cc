#include "scenarios/yaml_reader.h"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <iterator>

#include "scenarios/input_error.h"

namespace plumbline {
namespace {

constexpr std::size_t kMaxBytes = 1'000'000;
constexpr int kMaxNodes = 20'000;  // a few lines of aliases can stand for billions
constexpr int kMaxDepth = 32;      // and an alias to its own parent for an endless depth

/// Copies yaml-cpp's tree, which shares aliased nodes, into ours, which does not.
class Converter {
 public:
  Converter(std::string origin, std::filesystem::path directory, bool with_lines)
      : origin_(std::move(origin)), directory_(std::move(directory)), with_lines_(with_lines) {}

  ConfigNode convert(const YAML::Node& node, int depth = 0) {
    if (++nodes_ > kMaxNodes) fail(node.Mark(), "more than " + std::to_string(kMaxNodes) + " values");
    if (depth > kMaxDepth) fail(node.Mark(), "nested deeper than " + std::to_string(kMaxDepth) + " levels");
    check_tag(node);
    ConfigNode result;
    result.where = place(node.Mark());
    result.directory = directory_;
    if (node.IsMap()) {
      result.kind = ConfigNode::Kind::kMap;
      for (const auto& entry : node) add_entry(entry.first, entry.second, depth, result);
    } else if (node.IsSequence()) {
      result.kind = ConfigNode::Kind::kSequence;
      for (const auto& item : node) result.items.push_back(convert(item, depth + 1));
    } else if (node.IsScalar()) {
      result.text = node.Scalar();
      result.quoted = node.Tag() == "!";
    }
    return result;
  }

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what) const {
    throw InputError(place(mark) + ": " + what);
  }

 private:
  void add_entry(const YAML::Node& key, const YAML::Node& value, int depth, ConfigNode& map) {
    if (!key.IsScalar()) fail(key.Mark(), "a key must be a plain word");
    if (!map.entries.emplace(key.Scalar(), convert(value, depth + 1)).second) {
      fail(key.Mark(), "the key '" + key.Scalar() + "' stands here twice");
    }
  }

  void check_tag(const YAML::Node& node) const {
    const std::string& tag = node.Tag();
    if (!tag.empty() && tag != "?" && tag != "!")
      fail(node.Mark(), "found the tag '" + tag + "', tags are not allowed");
  }

  std::string place(const YAML::Mark& mark) const {
    return with_lines_ && !mark.is_null() ? origin_ + ":" + std::to_string(mark.line + 1) : origin_;
  }

  std::string origin_;
  std::filesystem::path directory_;
  bool with_lines_ = true;
  int nodes_ = 0;
};

ConfigNode parse(const std::string& text, Converter converter) {
  std::vector<YAML::Node> documents;
  try {
    documents = YAML::LoadAll(text);
  } catch (const YAML::DeepRecursion& error) {
    converter.fail(error.mark, "nested deeper than " + std::to_string(kMaxDepth) + " levels");
  } catch (const YAML::Exception& error) {
    converter.fail(error.mark, "not valid YAML: " + error.msg);
  }
  if (documents.size() > 1) converter.fail(documents[1].Mark(), "found a second document, one is allowed");
  return documents.empty() ? converter.convert(YAML::Node()) : converter.convert(documents.front());
}

}  // namespace

ConfigNode read_yaml_file(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(name + ": no such file");
  if (!std::filesystem::is_regular_file(path, error)) throw InputError(name + ": not a regular file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(name + ": cannot be opened");
  std::string text;
  // One byte more than allowed is enough to know; a file may be larger than its size says.
  for (std::istreambuf_iterator<char> it(stream), end; it != end && text.size() <= kMaxBytes; ++it) text += *it;
  if (text.size() > kMaxBytes) throw InputError(name + ": larger than 1 MB, which is the most a file may have");
  return parse(text, Converter(name, std::filesystem::absolute(path).parent_path(), /*with_lines=*/true));
}

ConfigNode read_yaml_text(const std::string& text, const std::string& origin, const std::filesystem::path& directory) {
  return parse(text, Converter(origin, directory, /*with_lines=*/false));
}

}  // namespace plumbline
