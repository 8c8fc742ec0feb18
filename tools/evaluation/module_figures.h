#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "scenarios/run_record.h"

namespace plumbline {

/// What one module cost, and how often its data left a direction open.
struct ModuleFigures {
  std::int64_t calls = 0;
  std::optional<double> mean_ms;
  std::optional<double> p50_ms;
  std::optional<double> p95_ms;
  std::optional<double> max_ms;
  std::optional<double> degenerate_share;       ///< of its solves; nothing for a module without any
  std::optional<double> nees_degenerate;        ///< see nees_degenerate()
  std::array<std::int64_t, 7> dof_histogram{};  ///< solves with 0 … 6 well-conditioned directions
};

ModuleFigures module_figures(const RunRecord& record, Module module);

}  // namespace plumbline
