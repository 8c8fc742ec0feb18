#include "tools/study/scenario_reducer.h"

#include <algorithm>
#include <string>

namespace plumbline {
namespace {

using Path = std::vector<std::string>;

ConfigNode* find(ConfigNode& node, const Path& path) {
  ConfigNode* at = &node;
  for (const std::string& key : path) {
    const auto found = at->entries.find(key);
    if (found == at->entries.end()) return nullptr;
    at = &found->second;
  }
  return at;
}

ConfigNode without(ConfigNode keys, const Path& path) {
  ConfigNode* parent = find(keys, {path.begin(), path.end() - 1});
  if (parent != nullptr) parent->entries.erase(path.back());
  return keys;
}

bool must_stay(const Path& path, const ConfigNode& value) {
  return path == Path{"seed"} || path == Path{"estimator", "name"} ||
         (path == Path{"estimator"} && value.entries.contains("name"));
}

/// Every key, sections before what they hold.
void append_paths(const ConfigNode& node, const Path& above, std::vector<Path>& paths) {
  for (const auto& [key, value] : node.entries) {
    Path path = above;
    path.push_back(key);
    if (!must_stay(path, value)) paths.push_back(path);
    append_paths(value, path, paths);
  }
}

/// Shorter motions, the shortest first; empty when it cannot be shorter.
std::vector<ConfigNode> shorter_motions(const ConfigNode& keys) {
  std::vector<ConfigNode> candidates;
  ConfigNode shorter = keys;
  ConfigNode* waypoints = find(shorter, {"motion", "waypoints"});
  if (waypoints != nullptr && waypoints->items.size() > 2) {
    const std::vector<ConfigNode> all = waypoints->items;
    std::size_t tried = 0;
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      const auto most = all.size() - 1;
      const auto count =
          std::clamp<std::size_t>(static_cast<std::size_t>(share * static_cast<double>(all.size())), 2, most);
      if (count == tried) continue;
      waypoints->items.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
      candidates.push_back(shorter);
      tried = count;
    }
  }
  return candidates;
}

/// The first of the candidates that still fails takes the place of `keys`.
/// @returns its index; the number of candidates if none does; one more if the search is to end
std::size_t take_first(ConfigNode& keys, const std::vector<ConfigNode>& candidates, std::size_t at_a_time,
                       const StillFails& still_fails) {
  for (std::size_t first = 0; first < candidates.size(); first += at_a_time) {
    const std::size_t last = std::min(candidates.size(), first + at_a_time);
    const std::vector<ConfigNode> batch(candidates.begin() + static_cast<std::ptrdiff_t>(first),
                                        candidates.begin() + static_cast<std::ptrdiff_t>(last));
    const std::vector<bool> fails = still_fails(batch);
    const auto found = std::find(fails.begin(), fails.end(), true);
    if (found != fails.end()) {
      const std::size_t index = first + static_cast<std::size_t>(found - fails.begin());
      keys = candidates[index];
      return index;
    }
    if (fails.size() < batch.size()) return candidates.size() + 1;
  }
  return candidates.size();
}

}  // namespace

ConfigNode reduced(ConfigNode keys, std::size_t at_a_time, const StillFails& still_fails) {
  for (;;) {
    const std::vector<ConfigNode> shorter = shorter_motions(keys);
    const std::size_t taken = take_first(keys, shorter, at_a_time, still_fails);
    if (taken > shorter.size()) return keys;
    if (taken == shorter.size()) break;
  }
  std::vector<Path> paths;
  append_paths(keys, {}, paths);
  while (!paths.empty()) {
    std::erase_if(paths, [&](const Path& path) { return find(keys, path) == nullptr; });
    std::vector<ConfigNode> candidates;
    for (const Path& path : paths) candidates.push_back(without(keys, path));
    const std::size_t taken = take_first(keys, candidates, at_a_time, still_fails);
    if (taken >= candidates.size()) return keys;
    // What was needed before the step is taken to be needed after it.
    paths.erase(paths.begin(), paths.begin() + static_cast<std::ptrdiff_t>(taken) + 1);
  }
  return keys;
}

}  // namespace plumbline
