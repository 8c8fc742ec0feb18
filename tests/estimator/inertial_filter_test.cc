#include "estimator/imu/inertial_filter.h"
#include "estimator/geometry/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "estimator/geometry/so3.h"
#include "sensors/imu.h"
#include "sim/random_stream.h"
#include "tests/support/aggressive_motion.h"

namespace plumbline {
namespace {

/// A pose known to 1 cm and 0.1 degrees in all directions, as a module's solution would give it.
SolveResult pose_fix(const Pose& pose, int well_conditioned = 6) {
  SolveResult fix;
  fix.pose = pose;
  fix.information.diagonal() << Eigen::Vector3d::Constant(1.0 / (0.00175 * 0.00175)),
      Eigen::Vector3d::Constant(1.0 / (0.01 * 0.01));
  fix.spectrum.eigenvalues = fix.information.diagonal();
  fix.spectrum.well_conditioned = well_conditioned;
  return fix;
}

struct Flight {
  InertialFilter filter;
  Pose start_from_world;
};

/// Mechanises a noisy IMU along the aggressive motion and fixes the pose ten times a second.
Flight run_with_fixes(std::uint64_t seed, double until_s, const ImuModel& model = {}) {
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), seed);
  Imu imu(model, seed);
  Calibration calibration;
  Initializer initializer(calibration);
  std::optional<Flight> run;
  ImuSample previous;
  RandomStream noise(seed, "fix");
  for (std::int64_t t = imu.period_ns(); t < static_cast<std::int64_t>(until_s * 1e9); t += imu.period_ns()) {
    const ImuSample sample = imu.sample(trajectory, t);
    if (!run) {
      if (const auto start = initializer.add(sample)) {
        run.emplace(Flight{InertialFilter(*start, calibration.imu, /*remapping=*/true),
                           start->state.world_from_body * trajectory.pose(t).inverse()});
      }
    } else {
      run->filter.predict(segment_between(previous, sample));
      if (t % 100'000'000 == 0) {
        Vector6d error;
        for (int i = 0; i < 6; ++i) error[i] = noise.gaussian() * (i < 3 ? 0.00175 : 0.01);
        const Pose truth = run->start_from_world * trajectory.pose(t);
        run->filter.update_pose(pose_fix(truth.retract(error)), run->filter.state().world_from_body, 1.0);
      }
    }
    previous = sample;
  }
  return *run;
}

TEST(InertialFilter, FindsTheBiasesAndGravitysLean) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Imu imu(ImuModel{}, seed);
    ImuModel quiet;
    quiet.noise.gyro_density = quiet.noise.accel_density = 0.0;
    Imu same_biases(quiet, seed);
    const Trajectory rest = make_trajectory(testing::aggressive_motion(), seed);
    const ImuSample turn_on = same_biases.sample(rest, same_biases.period_ns());
    const MotionState truth = rest.at(0);
    const Eigen::Vector3d true_accel_bias =
        turn_on.specific_force - truth.world_from_body.rotation.conjugate() * Eigen::Vector3d(0, 0, 9.81);
    const Flight run = run_with_fixes(seed, 30.0);
    // 20 s of bias random walk: 1e-3 sqrt(20) = 0.005 m/s^2 and 2e-5 sqrt(20) = 9e-5 rad/s, and 4 sigma of estimation.
    EXPECT_LT((run.filter.state().accel_bias - true_accel_bias).norm(), 0.04) << seed;
    EXPECT_LT((run.filter.state().gyro_bias - turn_on.angular_rate).norm(), 1e-3) << seed;
    const Eigen::Vector3d true_gravity = run.start_from_world.rotation * Eigen::Vector3d(0, 0, -9.81);
    EXPECT_LT((run.filter.state().gravity_in_world - true_gravity).norm(), 0.04) << seed;
  }
}

TEST(InertialFilter, ErrorsAreAsLargeAsItSays) {
  // Normalised squared error of the six pose components over 24 runs: mean 6, standard deviation sqrt(12 / 24) = 0.7.
  // The unit misreads what it measures as the filter allows for.
  ImuModel model;
  model.gyro.scale_sigma = model.accel.scale_sigma = 2e-3;
  model.g_sensitivity_sigma = 1.7e-4;
  double sum = 0.0;
  const int runs = 24;
  for (int seed = 1; seed <= runs; ++seed) {
    const double until_s = 12.0;
    const Flight run = run_with_fixes(static_cast<std::uint64_t>(seed), until_s, model);
    const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), static_cast<std::uint64_t>(seed));
    const Pose truth = run.start_from_world * trajectory.pose(run.filter.state().stamp_ns);
    const Vector6d error = truth.local(run.filter.state().world_from_body);
    sum += error.dot(run.filter.pose_covariance().inverse() * error);
  }
  EXPECT_GT(sum / runs, 3.0);
  EXPECT_LT(sum / runs, 9.0);
}

TEST(InertialFilter, TakesNothingAlongDirectionsThatWereNotSolved) {
  Flight run = run_with_fixes(5, 6.0);
  const Pose before = run.filter.state().world_from_body;
  SolveResult fix = pose_fix(before.retract((Vector6d() << 0, 0, 0, 0.5, 0, 0).finished()), 0);
  run.filter.update_pose(fix, before, 1.0);
  EXPECT_EQ(before.local(run.filter.state().world_from_body).norm(), 0.0);

  // Only B's z is solved (the last column): a fix that is wrong along x must not pull x at all by itself.
  Flight other = run_with_fixes(5, 6.0);
  const Eigen::Matrix<double, 6, 1> x_before = before.local(other.filter.state().world_from_body);
  fix.spectrum.well_conditioned = 1;
  other.filter.update_pose(fix, before, 1.0);
  EXPECT_LT((before.local(other.filter.state().world_from_body) - x_before).norm(), 1e-12);
}

/// A solution that is a metre off moves a filter that knows its pose to centimetres by a fraction of what one within
/// its own sigmas would, however sure it says it is.
TEST(InertialFilter, HardlyFollowsASolutionThatTheMotionRulesOut) {
  const auto moved_by = [](double offset_m) {
    Flight run = run_with_fixes(1, 20.0);
    const Pose before = run.filter.state().world_from_body;
    Vector6d offset = Vector6d::Zero();
    offset[4] = offset_m;
    run.filter.update_pose(pose_fix(before.retract(offset)), before, 1.0);
    return before.local(run.filter.state().world_from_body)[4] / offset_m;
  };
  // The innovation's length of 60 to 100 sigmas makes its noise hundreds of times larger.
  EXPECT_LT(moved_by(1.0), 0.1 * moved_by(0.01));
  EXPECT_GT(moved_by(0.01), 0.05) << "or the line above would compare nothing with nothing";
}

/// Many features average their own errors away, but not the factor that their depths share.
TEST(InertialFilter, ManyFeaturesDoNotMakeTheWayFromTheKeyframeCertain) {
  Flight run = run_with_fixes(1, 20.0);
  const Pose keyframe = run.filter.state().world_from_body;
  run.filter.set_keyframe(keyframe);
  InertialSegment second;
  second.start_ns = run.filter.state().stamp_ns;
  second.end_ns = second.start_ns + 1'000'000'000;
  second.rate = run.filter.state().gyro_bias;
  second.force = keyframe.rotation.conjugate() * -run.filter.state().gravity_in_world + run.filter.state().accel_bias;
  run.filter.predict(second);
  const Pose moved = keyframe.inverse() * run.filter.state().world_from_body;
  ASSERT_GT(moved.translation.norm(), 0.5);
  SolveResult sure = pose_fix(moved);
  sure.information *= 1e8;
  run.filter.update_keyframe_motion(sure, moved, 1.0);
  const Eigen::Vector3d way = (moved.rotation.conjugate() * moved.translation).normalized();
  const Eigen::Matrix3d covariance = run.filter.keyframe_motion_covariance().bottomRightCorner<3, 3>();
  // 1 % of the way, but for what the inertial prediction knew by itself, 0.25 %; across it the solution counts as it
  // is.
  EXPECT_GT(std::sqrt(way.dot(covariance * way)), 0.002 * moved.translation.norm());
  EXPECT_LT(std::sqrt(way.unitOrthogonal().dot(covariance * way.unitOrthogonal())), 1e-4);
}

TEST(InertialFilter, KeyframeMotionStartsCertain) {
  Flight run = run_with_fixes(2, 5.0);
  run.filter.set_keyframe(run.filter.state().world_from_body);
  EXPECT_LT(run.filter.keyframe_motion_covariance().norm(), 1e-9);
}

TEST(InertialFilter, CovarianceStaysOneOverAMinuteOfKeyframesAlone) {
  // Without any absolute fix the pose's covariance grows while that of the motion since the key-frame stays tiny: their
  // difference must survive rounding. Half a minute of it once made the motion's covariance indefinite.
  const Trajectory trajectory = make_trajectory(testing::aggressive_motion(), 1);
  Flight flight = run_with_fixes(1, 3.0);
  InertialFilter& filter = flight.filter;
  const std::int64_t period = 5'000'000;
  std::int64_t keyframe_ns = filter.state().stamp_ns;
  filter.set_keyframe(filter.state().world_from_body);
  ImuSample previous = exact_sample(trajectory, keyframe_ns - period, keyframe_ns);
  for (std::int64_t t = keyframe_ns + period; t < 60'000'000'000; t += period) {
    const ImuSample sample = exact_sample(trajectory, t - period, t);
    filter.predict(segment_between(previous, sample));
    previous = sample;
    if (t % 20'000'000 != 0) continue;
    const Pose motion = trajectory.pose(keyframe_ns).inverse() * trajectory.pose(t);
    SolveResult fix = pose_fix(motion);
    fix.information.diagonal() << 1.5e8, 9e8, 1.1e9, 1.3e6, 1.7e6, 2.9e6;  // what vision's features give indoors
    filter.update_keyframe_motion(fix, filter.world_from_keyframe().inverse() * filter.state().world_from_body, 25.0);
    if (t - keyframe_ns < 700'000'000) continue;
    filter.set_keyframe(filter.state().world_from_body);
    keyframe_ns = t;
    ASSERT_LT((filter.covariance() - filter.covariance().transpose()).cwiseAbs().maxCoeff(), 1e-14) << t;
    const SymmetricEigen<Matrix6d> eigen(filter.keyframe_motion_covariance());
    ASSERT_GT(eigen.values.minCoeff(), -1e-13) << t;
  }
}

TEST(InertialFilter, GravityHoldsTheAttitudeWhileTheMapBends) {
  // At rest, so that gravity is known to point down, with fixes against a map whose content is renewed by 3 % and bends
  // by 0.1 mrad in pitch a scan. Believed for absolute, the fixes would tilt the estimate by 60 mrad in a minute.
  InitialState start;
  start.tilt_sigma = 1e-4;
  start.gyro_bias_covariance.diagonal().setConstant(9e-8);
  start.velocity_sigma = 0.01;
  InertialFilter filter(start, ImuNoise{}, true);
  filter.renew_map(1.0, Matrix6d::Zero());
  Matrix6d bend = Matrix6d::Zero();
  bend(1, 1) = 1e-8;
  ImuSample sample;
  sample.specific_force = {0.0, 0.0, kStandardGravity};
  Vector6d drift = Vector6d::Zero();
  for (int k = 1; k <= 12000; ++k) {
    const ImuSample previous = std::exchange(sample, [&] {
      ImuSample next = sample;
      next.stamp_ns += 5'000'000;
      return next;
    }());
    filter.predict(segment_between(previous, sample));
    if (k % 20 != 0) continue;
    // The map's content: what was inserted where the map was thought to be, bent a little more. The body itself rests
    // at the origin.
    drift = 0.97 * drift + 0.03 * Pose{}.local(filter.map_from_body());
    drift[1] += 1e-4;
    SolveResult fix = pose_fix(Pose{}.retract(drift));
    fix.information *= 100.0;
    filter.update_pose(fix, filter.map_from_body(), 1.0);
    filter.renew_map(0.03, bend);
  }
  const double tilt = filter.state().world_from_body.rotation.angularDistance(Eigen::Quaterniond::Identity());
  EXPECT_LT(tilt, 0.03);
}

TEST(InertialFilter, RenewingTheMapMovesNothingInIt) {
  // After a fix the estimate is corrected by more than the map's frame is: the two part. New content is put where the
  // map's frame has the body, so that a wall that one scan has left and the next goes on with is one wall.
  Flight run = run_with_fixes(1, 3.0);
  InertialFilter& filter = run.filter;
  filter.renew_map(1.0, 1e-4 * Matrix6d::Identity());
  const Pose ahead = filter.map_from_body() * Pose{Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.0}};
  filter.update_pose(pose_fix(ahead), filter.map_from_body(), 1.0);
  const Pose before = filter.map_from_body();
  ASSERT_GT(before.local(filter.state().world_from_body).norm(), 1e-3);
  filter.renew_map(0.5, Matrix6d::Zero());
  EXPECT_LT(before.local(filter.map_from_body()).norm(), 1e-12);
}

TEST(InertialFilter, TheHeadingFollowsWhatTheStartDidNotKnowOfTheBias) {
  // Watched for a second with a bias that was wrong by 0.004 rad/s, the heading is wrong by 0.004 rad. At rest in a
  // known place the bias shows, and the heading with it.
  constexpr double kUnknownBias = 0.004;
  InitialState start;
  start.tilt_sigma = 1e-3;
  start.gyro_bias_covariance.diagonal().setConstant(kUnknownBias * kUnknownBias);
  start.velocity_sigma = 0.01;
  start.d_attitude_d_gyro_bias = -Eigen::Matrix3d::Identity();
  start.state.world_from_body.rotation = exp_so3({0.0, 0.0, kUnknownBias});
  InertialFilter filter(start, ImuNoise{}, true);
  ImuSample sample;
  sample.angular_rate = {0.0, 0.0, kUnknownBias};
  sample.specific_force = {0.0, 0.0, kStandardGravity};
  for (int k = 1; k <= 400; ++k) {
    const ImuSample previous = sample;
    sample.stamp_ns += 5'000'000;
    filter.predict(segment_between(previous, sample));
    if (k % 20 != 0) continue;
    SolveResult at_rest = pose_fix(Pose{});
    at_rest.information *= 100.0;
    filter.update_keyframe_motion(at_rest, filter.world_from_keyframe().inverse() * filter.state().world_from_body,
                                  1.0);
  }
  EXPECT_NEAR(filter.state().gyro_bias.z(), kUnknownBias, 0.1 * kUnknownBias);
  // The key-frame was made at the start, and its heading is corrected, too.
  EXPECT_LT(log_so3(filter.state().world_from_body.rotation).norm(), 0.2 * kUnknownBias);
}

/// Speeds up to 30 m/s on a winding road, brakes and stands, with nothing but motions since key-frames.
/// @param key_frame_turn_rad  by which all motions since one key-frame err alike, about each axis at random
/// @returns the sigma that the filter gives the place across its way [m]
double sigma_after_a_drive(double key_frame_turn_rad) {
  constexpr double kStep_s = 5e-3;
  constexpr double kAcceleration = 3.0;
  constexpr double kHalt_s = 25.0;
  InitialState start;
  start.tilt_sigma = 5e-3;
  start.gyro_bias_covariance.diagonal().setConstant(1e-8);
  start.velocity_sigma = 1e-3;
  InertialFilter filter(start, ImuNoise{}, true);
  RandomStream random(1, "key-frames");
  const auto speed = [](double t) {
    return t < 10.0 ? kAcceleration * t : std::clamp(kAcceleration * (kHalt_s - t), 0.0, 30.0);
  };
  const auto rate = [&](double t) { return speed(t) > 1.0 ? 0.2 * std::sin(0.6 * t) : 0.0; };
  SolveResult fix;
  fix.information.diagonal() << Eigen::Vector3d::Constant(1.0 / (2e-5 * 2e-5)),
      Eigen::Vector3d::Constant(1.0 / (1e-4 * 1e-4));
  fix.spectrum.eigenvalues = fix.information.diagonal();
  fix.spectrum.well_conditioned = 6;
  Vector6d shared = Vector6d::Zero();
  double yaw = 0.0;
  Pose body;
  Pose keyframe;
  for (int k = 1; k <= 5600; ++k) {
    InertialSegment segment;
    segment.start_ns = filter.state().stamp_ns;
    segment.end_ns = segment.start_ns + 5'000'000;
    const double t = kStep_s * (k - 0.5);
    const double before = speed(t - 0.5 * kStep_s);
    const double after = speed(t + 0.5 * kStep_s);
    segment.rate = {0.0, 0.0, rate(t)};
    segment.force = {(after - before) / kStep_s, rate(t) * 0.5 * (before + after), kStandardGravity};
    const double middle_yaw = yaw + 0.5 * kStep_s * rate(t);
    yaw += kStep_s * rate(t);
    body.translation +=
        0.5 * kStep_s * (before + after) * Eigen::Vector3d(std::cos(middle_yaw), std::sin(middle_yaw), 0.0);
    body.rotation = exp_so3({0.0, 0.0, yaw});
    filter.predict(segment);
    if (k % 8 == 0) {
      fix.pose = (keyframe.inverse() * body).retract(shared);
      filter.update_keyframe_motion(fix, filter.world_from_keyframe().inverse() * filter.state().world_from_body, 1.0);
    }
    if (k % 144 == 0) {
      filter.set_keyframe(filter.state().world_from_body);
      keyframe = body;
      for (int i = 0; i < 3; ++i) shared[i] = key_frame_turn_rad * random.gaussian();
    }
  }
  return std::sqrt(filter.pose_covariance()(4, 4));
}

/// Whatever it corrects on its way, no motion since a key-frame tells where the world lies or which way it is turned.
/// With a velocity in the world and copies of world poses, a drive of corrections made it a fifth surer than one
/// without, and over 700 m of motorway so sure that it jumped by decimetres when it came to stand.
TEST(InertialFilter, ItsOwnCorrectionsDoNotMakeItSurer) {
  const double undisturbed = sigma_after_a_drive(0.0);
  const double corrected = sigma_after_a_drive(3e-4);
  // Corrections change the way, and with it what its errors come to, by a thousandth or so.
  EXPECT_NEAR(corrected / undisturbed, 1.0, 0.02);
}

void dead_reckon_half_a_second(InertialFilter& filter) {
  InertialSegment segment;
  segment.start_ns = filter.state().stamp_ns;
  segment.end_ns = segment.start_ns + 500'000'000;
  segment.force = {0.0, 0.0, kStandardGravity};
  filter.predict(segment);
}

TEST(InertialFilter, TheMotionSinceThePastPoseStartsCertainAndGrows) {
  Flight run = run_with_fixes(2, 5.0);
  run.filter.set_past();
  EXPECT_LT(run.filter.past_motion_covariance().norm(), 1e-9);
  dead_reckon_half_a_second(run.filter);
  const Matrix6d covariance = run.filter.past_motion_covariance();
  EXPECT_GT(SymmetricEigen<Matrix6d>(covariance).values.minCoeff(), 0.0);
  // Half a second at a velocity known to a few centimetres a second.
  EXPECT_GT(covariance(3, 3), 1e-6);
  EXPECT_LT(covariance(3, 3), 1e-2);
}

/// An earlier pose was given out before it was corrected. A turn that told tilt from bias moved a pose by 1.6 m in 20 s
/// (there was as much wrong after 1.2 km), while each second's increment claimed to be good to a centimetre.
TEST(InertialFilter, KnowsByHowMuchItHasMovedTheMapInTheWorld) {
  Flight run = run_with_fixes(2, 5.0);
  run.filter.renew_map(1.0, Matrix6d::Zero());
  dead_reckon_half_a_second(run.filter);
  const Vector6d moved_before = run.filter.map_revision();
  const Pose world_before = run.filter.state().world_from_body;
  const Pose map_before = run.filter.map_from_body();
  const Pose seen = map_before.retract((Vector6d() << 0.02, 0.0, 0.0, 0.0, 0.1, 0.0).finished());
  run.filter.update_pose(pose_fix(seen), map_before, 1.0);
  const Vector6d moved =
      world_before.local(run.filter.state().world_from_body) - map_before.local(run.filter.map_from_body());
  EXPECT_GT(moved.tail<3>().norm(), 1e-4);
  EXPECT_LT((run.filter.map_revision() - moved_before - moved).norm(), 1e-6);
  // What was moved ten seconds ago is not in an increment of one.
  for (int i = 0; i < 20; ++i) dead_reckon_half_a_second(run.filter);
  EXPECT_LT(run.filter.map_revision().norm(), 0.01 * moved.norm());
}

}  // namespace
}  // namespace plumbline
