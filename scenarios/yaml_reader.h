#pragma once

#include <filesystem>
#include <string>

#include "scenarios/config_node.h"

namespace plumbline {

/// Reads a YAML file of at most 1 MB: one document, string keys, none twice, aliases written out up to a bound.
/// @throws InputError naming the file and line.
ConfigNode read_yaml_file(const std::filesystem::path& path);

/// The same for a text from elsewhere; `origin` stands in for the file's name in messages.
ConfigNode read_yaml_text(const std::string& text, const std::string& origin, const std::filesystem::path& directory);

}  // namespace plumbline
