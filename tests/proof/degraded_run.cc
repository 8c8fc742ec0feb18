#include "tests/proof/degraded_run.h"

#include <cmath>
#include <opencv2/core/utility.hpp>

#include "estimator/pipeline/vloam.h"
#include "scenarios/calibration.h"
#include "scenarios/session.h"
#include "tools/output/run_files.h"

namespace plumbline {
namespace {

int fewer(int count, double kept) { return std::max(1, static_cast<int>(std::lround(kept * count))); }

Calibration with_weaker_prior(Calibration calibration, double kept) {
  ImuNoise& imu = calibration.imu;
  for (double* noise : {&imu.gyro_density, &imu.accel_density, &imu.gyro_random_walk, &imu.accel_random_walk}) {
    *noise /= kept;
  }
  return calibration;
}

Vloam degraded_estimator(const Scenario& scenario, double strength) {
  const double kept = 1.0 - strength;
  VisionConfig vision;
  vision.features_per_cell = fewer(vision.features_per_cell, kept);
  ScanMatcherConfig matcher;
  matcher.plane_budget = fewer(matcher.plane_budget, kept);
  matcher.edge_budget = fewer(matcher.edge_budget, kept);
  matcher.plane_resolution_m /= kept;
  matcher.edge_resolution_m /= kept;
  return {with_weaker_prior(calibration_of(scenario.rig), kept), scenario.estimator, vision, matcher};
}

}  // namespace

int make_degraded_run(const DegradedRun& run) {
  const Scenario scenario = load_scenario(run.scenario, run.overrides, run.seed);
  RunDirectory directory(run.out);
  const World world = make_world(scenario);
  const RayScene rays(world);
  cv::setNumThreads(1);
  Vloam estimator = degraded_estimator(scenario, run.strength);
  directory.open();
  SessionOptions options;
  options.threads = 1;
  const RunRecord record = run_session(scenario, world, rays, options, estimator);
  const JudgedRun judged = write_run(
      directory, scenario, record,
      [&](const Eigen::Vector3d& point) { return rays.distance_to_surface(point, kMapErrorLimit); },
      make_provenance(scenario, options.threads));
  return judged.verdict.exit_code();
}

}  // namespace plumbline
