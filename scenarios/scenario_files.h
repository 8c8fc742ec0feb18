#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/config_node.h"

namespace plumbline {

/// A file laid on the files it names by `base`, and overrides ("key.path=value", YAML's flow style) on top, the last
/// one winning. `base` itself is gone from the result; nothing is known yet of which keys make sense.
/// @param path  empty: the overrides are all there is
/// @throws InputError for a file that cannot be read, a base that leads back to itself, or a malformed override.
ConfigNode read_scenario_files(const std::filesystem::path& path, const std::vector<std::string>& overrides);

}  // namespace plumbline
