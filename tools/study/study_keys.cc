#include "tools/study/study_keys.h"

#include <set>

namespace plumbline {
namespace {

constexpr Range kSeedCount{1, 10'000};
constexpr Range kTime_s{0.1, 1e6};
constexpr Range kMemory_mb{1.0, 1e7};

}  // namespace

void read_seeds(ConfigReader& reader, std::vector<std::uint64_t>& seeds) {
  const ConfigNode* node = reader.find("seeds");
  if (node == nullptr) return;
  if (!node->is_sequence()) {
    const auto count = static_cast<std::uint64_t>(integer_of(*node, "seeds", kSeedCount));
    for (std::uint64_t seed = 1; seed <= count; ++seed) seeds.push_back(seed);
    return;
  }
  if (node->items.empty()) fail_at(*node, "seeds", "at least one seed");
  std::set<std::uint64_t> distinct;
  for (const ConfigNode& item : node->items) {
    const auto seed = static_cast<std::uint64_t>(integer_of(item, "seeds", {0, 9e18}));
    if (!distinct.insert(seed).second) fail_at(item, "seeds", "each seed once");
  }
  seeds.assign(distinct.begin(), distinct.end());
}

void read_limits(ConfigReader& reader, RunLimits& limits, const std::function<void(ConfigReader&)>& further) {
  reader.section("limits", [&](ConfigReader& section) {
    section.read("time_s", limits.time_s, kTime_s);
    section.read("memory_mb", limits.memory_mb, kMemory_mb);
    if (further) further(section);
  });
}

void read_fixed(ConfigReader& reader, std::vector<std::string>& fixed) {
  const ConfigNode* node = reader.find("set");
  if (node == nullptr) return;
  if (!node->is_map()) fail_at(*node, reader.path_of("set"), "a map of scenario keys and their values");
  for (const auto& [key, value] : node->entries) fixed.push_back(key + "=" + flow_yaml(value));
}

}  // namespace plumbline
