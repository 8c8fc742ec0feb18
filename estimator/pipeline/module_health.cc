#include "estimator/pipeline/module_health.h"

namespace plumbline {
namespace {

ModuleMode mode_of(int well_conditioned) {
  if (well_conditioned == 6) return ModuleMode::kSolved;
  return well_conditioned == 0 ? ModuleMode::kBypassed : ModuleMode::kPartial;
}

}  // namespace

ModuleHealth health_of(std::int64_t stamp_ns, Module module, const SolveResult& solved, const Pose& predicted,
                       double seconds) {
  ModuleHealth health;
  health.stamp_ns = stamp_ns;
  health.module = module;
  health.mode = mode_of(solved.spectrum.well_conditioned);
  health.eigenvalues = solved.spectrum.eigenvalues;
  health.eigenvectors = solved.spectrum.eigenvectors;
  health.well_conditioned = solved.spectrum.well_conditioned;
  health.rows = solved.features;
  health.inliers = solved.inliers;
  health.correction = predicted.local(solved.pose);
  health.processing_s = seconds;
  return health;
}

}  // namespace plumbline
