#include "tools/evaluation/module_figures.h"

#include <algorithm>
#include <numeric>

#include "tools/evaluation/quantile.h"

namespace plumbline {
namespace {

void add_timing(ModuleFigures& figures, const std::vector<TimingRow>& timing, Module module) {
  std::vector<double> ms;
  for (const TimingRow& row : timing) {
    if (row.module == module) ms.push_back(1e3 * row.wall_s);
  }
  figures.calls = static_cast<std::int64_t>(ms.size());
  if (ms.empty()) return;
  figures.mean_ms = std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
  figures.p50_ms = quantile(ms, 0.5);
  figures.p95_ms = quantile(ms, 0.95);
  figures.max_ms = *std::max_element(ms.begin(), ms.end());
}

void add_degeneracy(ModuleFigures& figures, const std::vector<ModuleHealth>& health, Module module) {
  std::int64_t solves = 0;
  std::int64_t degenerate = 0;
  for (const ModuleHealth& row : health) {
    if (row.module != module) continue;
    ++solves;
    if (row.well_conditioned < 6) ++degenerate;
    ++figures.dof_histogram[static_cast<std::size_t>(std::clamp(row.well_conditioned, 0, 6))];
  }
  if (solves > 0) figures.degenerate_share = static_cast<double>(degenerate) / static_cast<double>(solves);
}

}  // namespace

ModuleFigures module_figures(const RunRecord& record, Module module) {
  ModuleFigures figures;
  add_timing(figures, record.timing, module);
  add_degeneracy(figures, record.health, module);
  return figures;
}

}  // namespace plumbline
