#pragma once

#include <chrono>
#include <cstdint>

#include "estimator/estimator.h"
#include "estimator/solver/robust_solver.h"

namespace plumbline {

/// Wall time since its making.
class StopWatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// A solve as degeneracy.csv and the report tell of it.
ModuleHealth health_of(std::int64_t stamp_ns, Module module, const SolveResult& solved, const Pose& predicted,
                       double seconds);

}  // namespace plumbline
