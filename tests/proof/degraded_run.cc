#include "tests/proof/degraded_run.h"

#include <opencv2/core/utility.hpp>

#include "estimator/pipeline/vloam.h"
#include "scenarios/calibration.h"
#include "scenarios/session.h"
#include "tools/output/run_files.h"

namespace plumbline {
namespace {

Calibration with_weaker_prior(Calibration calibration, double kept) {
  ImuNoise& imu = calibration.imu;
  for (double* noise : {&imu.gyro_density, &imu.accel_density, &imu.gyro_random_walk, &imu.accel_random_walk}) {
    *noise /= kept;
  }
  return calibration;
}

Vloam degraded_estimator(const Scenario& scenario, double strength) {
  const double kept = 1.0 - strength;
  EstimatorConfig config = scenario.estimator;
  config.feature_share = kept;
  config.resolution_factor = 1.0 / kept;
  return {with_weaker_prior(calibration_of(scenario), kept), config};
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
