#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "scenarios/recording.h"
#include "scenarios/run_record.h"
#include "scenarios/scenario.h"
#include "sim/ray_scene.h"
#include "sim/surroundings.h"
#include "sim/trajectory.h"

namespace plumbline {

/// The fault of a run that its user ended.
inline constexpr const char* kInterrupted = "interrupted";

struct SessionOptions {
  int threads = 2;  ///< 1: everything in turn; 2 and more: sensors ahead of the estimator. The bytes are the same.
  /// Called now and then with the simulated share done, [0, 1]; false ends the run there, its record so far kept and
  /// marked as interrupted.
  std::function<bool(double)> progress;
  /// Where the estimate's world lies, if that is known: a mission is flown by it, otherwise it is laid out from its
  /// pad.
  std::optional<Pose> world_from_estimate;
  /// Called with what was tracked in each image that vision worked on.
  std::function<void(std::int64_t stamp_ns, const std::vector<TrackedFeature>&)> on_image;
};

/// The world of a scenario, light level set. @throws InputError
World make_world(const Scenario& scenario);

/// The body's exact motion in a scenario, stamps counted from 0. @throws InputError, also for a flight in closed loop,
/// whose motion is not known ahead
Trajectory make_body_trajectory(const Scenario& scenario, const World& world, const RayScene& rays);

/// Where the IMU is when a run begins, as if surveyed. @throws InputError
Pose world_from_imu_at_start(const Scenario& scenario, const World& world, const RayScene& rays);

/// The vehicle as its sensors see it; nullptr where there is none, or it is left out.
std::unique_ptr<OwnBody> make_own_body(const Scenario& scenario);

/// Who is told of a session as it goes on: of the truth, which is always ahead of the messages, and of each message in
/// order of arrival, the lost ones included; the latter gives false to end the session there.
struct SessionListener {
  std::function<void(std::int64_t stamp_ns, const Pose& world_from_body)> truth;
  std::function<bool(const SensorMessage&)> message;
};

/// Simulates a scenario's world, motion and sensors without an estimator. @return false if `progress` ended it
bool simulate(const Scenario& scenario, const World& world, const RayScene& rays, const SessionOptions& options,
              const SessionListener& listener);

/// Runs a scenario in lock-step: world, motion, sensors, estimator. A fault of the estimator ends the run and is kept
/// in the record; bad input throws InputError before anything is simulated.
///
/// Messages come in order of arrival: without delays IMU samples and images at their stamps, a scan at its end; of
/// those that arrive at one time the IMU sample first, then the image, then the scan. Truth is logged in true time,
/// whatever the sensors' clocks show. Its body, as the estimator's, is the IMU.
RunRecord run_session(const Scenario& scenario, const World& world, const RayScene& rays,
                      const SessionOptions& options);

/// The same with an estimator of the caller's.
RunRecord run_session(const Scenario& scenario, const World& world, const RayScene& rays, const SessionOptions& options,
                      Estimator& estimator);

/// The same with several estimators on one simulation, each as if it were alone. A fault ends the run of the estimator
/// whose it is. @throws InputError for a flight in closed loop, which only one can fly
std::vector<RunRecord> run_session(const Scenario& scenario, const World& world, const RayScene& rays,
                                   const SessionOptions& options, const std::vector<Estimator*>& estimators);

/// Drives an estimator with recorded messages. Of the truth, what lies within the messages' span is kept.
RunRecord run_recording(const Recording& recording, const SessionOptions& options, Estimator& estimator);

}  // namespace plumbline
