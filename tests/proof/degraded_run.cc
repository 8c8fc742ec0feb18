#include "tests/proof/degraded_run.h"

#include <memory>
#include <opencv2/core/utility.hpp>
#include <vector>

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

int make_degraded_runs(const DegradedRuns& runs) {
  const Scenario scenario = load_scenario(runs.scenario, runs.overrides, runs.seed);
  const World world = make_world(scenario);
  const RayScene rays(world);
  cv::setNumThreads(1);
  std::vector<std::unique_ptr<Vloam>> estimators;
  std::vector<Estimator*> driven;
  for (const Degradation& degradation : runs.degradations) {
    estimators.push_back(std::make_unique<Vloam>(degraded_estimator(scenario, degradation.strength)));
    driven.push_back(estimators.back().get());
  }
  SessionOptions options;
  options.threads = 1;
  const std::vector<RunRecord> records = run_session(scenario, world, rays, options, driven);
  std::vector<int> exit_codes;
  for (std::size_t i = 0; i < records.size(); ++i) {
    RunDirectory directory(runs.degradations[i].out);
    directory.open();
    const JudgedRun judged = write_run(
        directory, scenario, records[i],
        [&](const Eigen::Vector3d& point) { return rays.distance_to_surface(point, kMapErrorLimit); },
        make_provenance(scenario, options.threads));
    exit_codes.push_back(judged.verdict.exit_code());
  }
  return exit_codes.front();
}

}  // namespace plumbline
