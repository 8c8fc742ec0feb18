#include "estimator/imu/initialization.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "estimator/geometry/so3.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
const Eigen::Vector3d kUp(0.0, 0.0, kStandardGravity);
const Eigen::Vector3d kBias(-0.005, 0.0, -0.012);

struct Reading {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = kUp;
};

/// Runs an initializer on a motion as a unit with a bias and the calibration's white noise reads it.
InitialState start_on(const std::function<Reading(double)>& motion, const Eigen::Vector3d& bias = kBias) {
  Calibration calibration;
  Initializer initializer(calibration);
  RandomStream noise(1, "noise");
  const double root_rate = std::sqrt(calibration.imu_rate_hz);
  const auto white = [&](double density) {
    return Eigen::Vector3d(Eigen::Vector3d(noise.gaussian(), noise.gaussian(), noise.gaussian()) * density * root_rate);
  };
  for (int i = 1;; ++i) {
    const double t = i / calibration.imu_rate_hz;
    const Reading exact = motion(t);
    const auto start = initializer.add({static_cast<std::int64_t>(std::llround(t * 1e9)),
                                        exact.rate + bias + white(calibration.imu.gyro_density),
                                        exact.force + white(calibration.imu.accel_density)});
    if (start) return *start;
    if (t > 2.0) throw std::runtime_error("never started");
  }
}

/// Within three of the sigmas that the start itself gives.
void expect_bias_within_its_sigmas(const InitialState& start, const Eigen::Vector3d& bias) {
  for (int i = 0; i < 3; ++i) {
    const double sigma = std::sqrt(start.gyro_bias_covariance(i, i));
    EXPECT_LT(std::abs(start.state.gyro_bias[i] - bias[i]), 3.0 * sigma) << i << ": " << sigma;
  }
}

TEST(Initializer, AtRestFindsTheGyroBiasWithinASecond) {
  const InitialState start = start_on([](double) { return Reading{}; });
  EXPECT_NEAR(start.state.stamp_ns * 1e-9, 1.0, 0.01);
  // White noise averaged for a second, four sigmas.
  EXPECT_LT((start.state.gyro_bias - kBias).norm(), 4.0 * Calibration{}.imu.gyro_density);
  EXPECT_LT(start.velocity_sigma, 0.05);
  EXPECT_LT(start.tilt_sigma, 0.01);
}

/// A hand sways by a degree at 1.3 Hz: its mean rate over a second is not zero, and the start knows it.
TEST(Initializer, AHandThatSwaysLeavesTheBiasUnsure) {
  const auto sway = [](double t) {
    Reading reading;
    const double phase = kTwoPi * 1.3 * t;
    reading.rate.x() = 0.01 * kTwoPi * 1.3 * std::cos(phase);
    reading.force = Eigen::AngleAxisd(-0.01 * std::sin(phase), Eigen::Vector3d::UnitX()) * kUp;
    return reading;
  };
  const InitialState swaying = start_on(sway);
  const InitialState resting = start_on([](double) { return Reading{}; });
  expect_bias_within_its_sigmas(swaying, kBias);
  EXPECT_GT(swaying.gyro_bias_covariance(0, 0), 25.0 * resting.gyro_bias_covariance(0, 0));
  EXPECT_LT(swaying.velocity_sigma, 0.1);
}

/// A craft that hovers in the wind swings over three seconds, and trembles: most of what it turns in the one second
/// that it is watched for looks like a bias.
TEST(Initializer, ASlowSwingIsNotTakenForASureBias) {
  const double slow = kTwoPi / 3.0;
  const double fast = kTwoPi * 1.3;
  for (double phase = 0.0; phase < kTwoPi; phase += kTwoPi / 8.0) {
    const InitialState start = start_on([&](double t) {
      const double rate = 0.01 * slow * std::cos(slow * t + phase) + 0.003 * fast * std::cos(fast * t);
      return Reading{Eigen::Vector3d(0.0, 0.0, rate), kUp};
    });
    SCOPED_TRACE(phase);
    expect_bias_within_its_sigmas(start, kBias);
  }
}

/// The world's x axis is where the first sample looked, so what the hand turns while it is watched is heading. The mean
/// rate is beyond the data sheet's bias, but nothing is still: it is a turn.
TEST(Initializer, AHandThatTurnsWhileWatchedHasTurned) {
  constexpr double kTurn = 0.06;  // [rad] within the second, with a swing on top
  const auto turn = [&](double t) {
    Reading reading;
    reading.rate.z() = kTurn + 0.003 * kTwoPi * 1.3 * std::cos(kTwoPi * 1.3 * t);
    return reading;
  };
  const double truth = kTurn + 0.003 * std::sin(kTwoPi * 1.3);
  const Eigen::Vector3d no_bias = Eigen::Vector3d::Zero();
  const InitialState start = start_on(turn, no_bias);
  const Eigen::Vector3d ahead = start.state.world_from_body.rotation * Eigen::Vector3d::UnitX();
  const double sigma = std::sqrt(start.gyro_bias_covariance(2, 2));  // times the second it was watched
  EXPECT_NEAR(std::atan2(ahead.y(), ahead.x()), truth, 2.0 * sigma);
  EXPECT_LT(2.0 * sigma, 0.4 * kTurn);  // or the line above would pass whatever was said
}

/// A pack that looks down by 45 degrees and turns slowly, which passes for a bias: once the bias is known, the attitude
/// at the start follows, its heading from all three axes.
TEST(Initializer, KnowsWhatItsAttitudeOwesToTheBias) {
  const Eigen::Vector3d bias(-0.004, 0.0, -0.014);
  const Eigen::Quaterniond level_from_start(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d turn(0.004, 0.006, 0.012);  // [rad/s] in B
  const auto attitude = [&](double t) { return level_from_start * exp_so3(t * turn); };
  const InitialState start = start_on([&](double t) { return Reading{turn, attitude(t).conjugate() * kUp}; }, bias);
  const Eigen::Vector3d unknown = bias - start.state.gyro_bias;
  ASSERT_GT(unknown.norm(), 0.005);
  const double t = start.state.stamp_ns * 1e-9;
  const auto error = [&](const Eigen::Quaterniond& found) { return log_so3(attitude(t).conjugate() * found).norm(); };
  const Eigen::Quaterniond& found = start.state.world_from_body.rotation;
  EXPECT_GT(error(found), 0.004);
  // What is left is the force's noise and the tilt that the turn put into its mean.
  EXPECT_LT(error(found * exp_so3(start.d_attitude_d_gyro_bias * unknown)), 0.0015);
}

/// What is given out before the start is a pose as any other: it turns as the hand does, and goes over into the state
/// without a step.
TEST(Initializer, OutputsBeforeTheStartTurnAsTheHandDoes) {
  Calibration calibration;
  Initializer initializer(calibration);
  // A sway of half a degree at 1.3 Hz; tilt and heading alike.
  const double amplitude = 0.009, frequency = kTwoPi * 1.3;
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 0.0, 1.0).normalized();
  Eigen::Quaterniond before = Eigen::Quaterniond::Identity();
  double sum_of_squares = 0.0, sum_of_squares_of_errors = 0.0;
  bool started = false;
  for (int i = 1; !started; ++i) {
    const double t = i / calibration.imu_rate_hz;
    ASSERT_LT(t, 2.0);
    const Eigen::AngleAxisd turned(amplitude * std::sin(frequency * t), axis);
    const auto start = initializer.add({static_cast<std::int64_t>(std::llround(t * 1e9)),
                                        amplitude * frequency * std::cos(frequency * t) * axis,
                                        turned.toRotationMatrix().transpose() * kUp});
    started = start.has_value();
    const Eigen::Quaterniond given = (start ? start->state.world_from_body : initializer.attitude()).rotation;
    if (started) {
      EXPECT_LT(given.angularDistance(before), 0.2 * amplitude);  // a sample's turn is up to 0.04
    }
    before = given;
    sum_of_squares += std::pow(turned.angle(), 2);
    sum_of_squares_of_errors += std::pow(given.angularDistance(Eigen::Quaterniond(turned)), 2);
  }
  // A part of the mean rate passes for bias, as it may be one; outputs that do not turn would err by all.
  EXPECT_LT(std::sqrt(sum_of_squares_of_errors), 0.5 * std::sqrt(sum_of_squares));
}

/// Ten times the unit's noise at 40 Hz, as an idle engine or standing rotors make, moves the body by micrometres: it
/// is no motion, and a bias far beyond the data sheet's is still found.
TEST(Initializer, VibrationAtRestIsNoMotion) {
  const Eigen::Vector3d large_bias(-0.003, 0.02, 0.075);
  const auto vibration = [](double t) {
    Reading reading;
    const double swing = std::sin(kTwoPi * 40.0 * t);
    reading.rate.setConstant(0.05 * swing);
    reading.force += Eigen::Vector3d::Constant(0.5 * swing);
    return reading;
  };
  const InitialState start = start_on(vibration, large_bias);
  EXPECT_LT((start.state.gyro_bias - large_bias).norm(), 2e-3);
  EXPECT_LT(start.velocity_sigma, 0.1);
}

/// As when rotors are turned by hand before a flight: it rocks as far as a car does on the road, but was still before.
/// An engine that idles shakes the first samples by degrees. What a second has brought the attitude is what the first
/// outputs were wrong by; over many phases of the shaking its square has to be what the outputs claimed.
TEST(Initializer, OutputsBeforeTheStartKnowThatTheyWereShaken) {
  constexpr int kPhases = 12;
  double normalised = 0.0;
  for (int phase = 0; phase < kPhases; ++phase) {
    Calibration calibration;
    Initializer initializer(calibration);
    RandomStream noise(static_cast<std::uint64_t>(phase), "noise");
    const double sigma = calibration.imu.accel_density * std::sqrt(calibration.imu_rate_hz);
    Pose first;
    Matrix6d claimed = Matrix6d::Zero();
    for (int i = 0; i < 190; ++i) {
      const double t = i / calibration.imu_rate_hz;
      const double shaken = 0.8 * std::cos(kTwoPi * (12.0 * t + phase / static_cast<double>(kPhases)));
      const Eigen::Vector3d force = kUp + Eigen::Vector3d(shaken, noise.gaussian() * sigma, noise.gaussian() * sigma);
      initializer.add({std::llround(t * 1e9), Eigen::Vector3d::Zero(), force});
      if (i == 0)
        first = initializer.attitude();
      else
        claimed += initializer.increment_covariance();
    }
    const double error = first.local(initializer.attitude())[1];
    normalised += error * error / claimed(1, 1) / kPhases;
  }
  EXPECT_GT(normalised, 0.3);
  EXPECT_LT(normalised, 4.0);  // it was hundreds
}

TEST(Initializer, KnockedAtRestIsNotUnderWay) {
  const auto knocked = [](double t) {
    Reading reading;
    const double swing = t < 0.25 ? 0.0 : std::exp(-2.0 * (t - 0.25)) * std::sin(kTwoPi * 10.0 * (t - 0.25));
    reading.force.y() += 3.0 * swing;
    reading.rate.x() = 0.15 * swing;
    return reading;
  };
  const InitialState start = start_on(knocked);
  expect_bias_within_its_sigmas(start, kBias);
  EXPECT_LT(start.velocity_sigma, 0.2);
  EXPECT_LT(start.tilt_sigma, 0.02);
}

/// A car on the road at constant speed shakes at the frequencies of its suspension; nothing tells its speed.
TEST(Initializer, OnTheRoadTheVelocityIsUnknown) {
  const auto road = [](double t) {
    Reading reading;
    reading.force.z() += 0.6 * std::cos(kTwoPi * 1.4 * t);
    return reading;
  };
  const InitialState start = start_on(road);
  expect_bias_within_its_sigmas(start, kBias);
  EXPECT_GE(start.velocity_sigma, 5.0);
  EXPECT_GE(start.tilt_sigma, 0.03);
}

TEST(Initializer, ASteadyTurnOnTheRoadIsNoBias) {
  const auto bend = [](double t) {
    Reading reading;
    reading.rate.z() = 0.08;
    reading.force.z() += 0.6 * std::cos(kTwoPi * 1.4 * t);
    return reading;
  };
  const InitialState start = start_on(bend);
  expect_bias_within_its_sigmas(start, kBias);
}

TEST(Initializer, InAManoeuvreStartsAtOnce) {
  const auto shaking = [](double t) {
    Reading reading;
    reading.rate.x() = 3.0 * std::sin(kTwoPi * t);
    return reading;
  };
  const InitialState start = start_on(shaking);
  EXPECT_LT(start.state.stamp_ns * 1e-9, 0.3);
  EXPECT_TRUE(start.state.gyro_bias.isZero());
  expect_bias_within_its_sigmas(start, kBias);
  EXPECT_GE(start.velocity_sigma, 5.0);
}

}  // namespace
}  // namespace plumbline
