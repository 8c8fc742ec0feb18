#include "sim/scenes/garage_plan.h"

#include <cmath>

namespace plumbline {

GaragePlan::GaragePlan(const SceneValues& values, std::uint64_t world_seed)
    : halls(static_cast<int>(std::lround(values.at("hall_count")))),
      length(values.at("hall_length_m")),
      width(values.at("hall_width_m")),
      ceiling(values.at("ceiling_m")),
      clutter(values.at("clutter")),
      pillar_spacing(values.at("pillar_spacing_m")),
      seed(world_seed) {}

std::vector<double> GaragePlan::pillar_rows() const {
  std::vector<double> rows;
  const double first = kIslandInsetM + 0.5;
  for (int i = 0; first + i * pillar_spacing <= length - first; ++i) rows.push_back(first + i * pillar_spacing);
  return rows;
}

}  // namespace plumbline
