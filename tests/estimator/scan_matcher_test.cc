#include "estimator/lidar/scan_matcher.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "estimator/geometry/so3.h"
#include "estimator/lidar/deskew.h"
#include "tests/support/box_world.h"

namespace plumbline {
namespace {

using testing::BoxWorld;
using testing::kRangeSigma;

constexpr double kDegree = std::numbers::pi / 180.0;

Calibration calibration() {
  Calibration c;
  c.lidar_range_sigma_m = kRangeSigma;
  c.body_from_lidar.translation = {0.1, 0.0, 0.15};
  return c;
}

Pose at(double x, double y = 0.0, double yaw = 0.0) { return {rotation_from_rpy({0, 0, yaw}), {x, y, 0.0}}; }

FeatureCloud still_scan(const BoxWorld& world, const Pose& pose, RandomStream& noise) {
  const Calibration c = calibration();
  const LidarScan scan = testing::vlp16_scan(
      world, [&](double) { return pose; }, 0, c.body_from_lidar, kRangeSigma, noise);
  PoseTrack rest;
  rest.push(0, {});
  return extract_features(scan, deskew(scan, rest, c.body_from_lidar, 0), c);
}

/// A matcher that has mapped a world from true poses a little apart.
ScanMatcher mapped(const BoxWorld& world, RandomStream& noise, WeakDirections weak = WeakDirections::kGuessed,
                   int scans = 6) {
  ScanMatcher matcher(calibration(), {}, weak);
  for (int k = 0; k < scans; ++k) matcher.insert(still_scan(world, at(0.1 * k), noise), at(0.1 * k), 0.1 * k);
  return matcher;
}

PosePrior loose(const Pose& mean) { return {mean, Matrix6d::Identity() * 1.0}; }

Vector6d offset(double metres, double degrees) {
  Vector6d d;
  d << Eigen::Vector3d(1, -1, 1).normalized() * degrees * kDegree, Eigen::Vector3d(1, 1, -1).normalized() * metres;
  return d;
}

TEST(ScanMatcher, WithAnEmptyMapNothingIsWellConditioned) {
  RandomStream noise(1, "lidar");
  ScanMatcher matcher(calibration(), {});
  const SolveResult result = matcher.match(still_scan(testing::furnished_room(), at(0), noise), loose(at(0.3)));
  EXPECT_EQ(result.spectrum.well_conditioned, 0);
  EXPECT_EQ(at(0.3).local(result.pose).norm(), 0.0);
}

TEST(ScanMatcher, FindsBackFromTenCentimetresAndTwoDegrees) {
  RandomStream noise(2, "lidar");
  const BoxWorld room = testing::furnished_room();
  ScanMatcher matcher = mapped(room, noise);
  const Pose truth = at(0.7, 0.1, 0.05);
  const FeatureCloud scan = still_scan(room, truth, noise);
  for (const double sign : {1.0, -1.0}) {
    const SolveResult result = matcher.match(scan, loose(truth.retract(sign * offset(0.1, 2.0))));
    EXPECT_EQ(result.spectrum.well_conditioned, 6);
    const Vector6d error = truth.local(result.pose);
    EXPECT_LT(error.tail<3>().norm(), 0.01);
    EXPECT_LT(error.head<3>().norm(), 0.1 * kDegree);
  }
}

/// Thesis Table 6.4 asks what less effort costs; it may cost accuracy, not the way.
TEST(ScanMatcher, CoarserIsLessWorkAndStillFindsBack) {
  const BoxWorld room = testing::furnished_room();
  const Pose truth = at(0.7, 0.1, 0.05);
  std::size_t rows_before = std::numeric_limits<std::size_t>::max();
  for (const double factor : {1.0, 2.0}) {
    SCOPED_TRACE(factor);
    RandomStream noise(2, "lidar");
    ScanMatcher matcher(calibration(), {.resolution_factor = factor});
    for (int k = 0; k < 6; ++k) matcher.insert(still_scan(room, at(0.1 * k), noise), at(0.1 * k), 0.1 * k);
    const SolveResult result = matcher.match(still_scan(room, truth, noise), loose(truth.retract(offset(0.1, 2.0))));
    EXPECT_EQ(result.spectrum.well_conditioned, 6);
    EXPECT_LT(truth.local(result.pose).tail<3>().norm(), 0.01 * factor);
    EXPECT_LT(matcher.rows().size(), rows_before);
    rows_before = matcher.rows().size();
  }
}

TEST(ScanMatcher, OneScanIsMapEnoughForTheNext) {
  RandomStream noise(3, "lidar");
  const BoxWorld room = testing::furnished_room();
  ScanMatcher matcher = mapped(room, noise, WeakDirections::kGuessed, 1);
  const SolveResult result = matcher.match(still_scan(room, at(0.1), noise), loose(at(0.0)));
  EXPECT_EQ(result.spectrum.well_conditioned, 6);
  EXPECT_LT(at(0.1).local(result.pose).tail<3>().norm(), 0.01);
}

TEST(ScanMatcher, OutsideTheMapNothingIsWellConditioned) {
  RandomStream noise(4, "lidar");
  const BoxWorld room = testing::furnished_room();
  ScanMatcher matcher = mapped(room, noise);
  EXPECT_EQ(matcher.match(still_scan(room, at(0.5), noise), loose(at(500.0))).spectrum.well_conditioned, 0);
}

// The axis of a smooth tunnel: flagged, left exactly at the guess, and the other five directions solved.
TEST(ScanMatcher, InATunnelOnlyTheAxisKeepsTheGuess) {
  RandomStream noise(5, "lidar");
  const BoxWorld tunnel = testing::smooth_tunnel();
  ScanMatcher matcher = mapped(tunnel, noise);
  const Pose truth = at(0.6, 0.3, 0.2);
  const Pose guess = truth.retract(offset(0.08, 1.0));
  const SolveResult result = matcher.match(still_scan(tunnel, truth, noise), loose(guess));
  ASSERT_EQ(result.spectrum.well_conditioned, 5);
  const Vector6d weak = result.spectrum.eigenvectors.col(0);
  const Eigen::Vector3d axis_in_body = guess.rotation.conjugate() * Eigen::Vector3d::UnitX();
  EXPECT_GT(std::abs(weak.tail<3>().dot(axis_in_body)), 0.95);
  EXPECT_LT(std::abs(weak.dot(guess.local(result.pose))), 1e-13);
  const Vector6d error = truth.local(result.pose);
  const Eigen::Vector3d in_world = truth.rotation * error.tail<3>();
  EXPECT_LT(in_world.tail<2>().norm(), 0.01);
  EXPECT_LT(error.head<3>().norm(), 0.1 * kDegree);
  EXPECT_GT(result.spectrum.eigenvalues[1], 50.0 * result.spectrum.eigenvalues[0]);
}

std::vector<float> random_biases(RandomStream& noise) {
  std::vector<float> bias_m(16);
  for (float& b : bias_m) b = static_cast<float>(kRangeSigma * noise.gaussian());
  return bias_m;
}

/// @param bias_m  by which the ranges of each ring err
FeatureCloud biased_scan(const BoxWorld& world, const Pose& pose, const std::vector<float>& bias_m,
                         const RangeBiases& known, const Calibration& c, RandomStream& noise) {
  LidarScan scan = testing::vlp16_scan(
      world, [&](double) { return pose; }, 0, c.body_from_lidar, kRangeSigma, noise);
  for (LidarPoint& point : scan.points) point.position += bias_m[point.ring] * point.position.normalized();
  scan = known.taken_off(scan);
  PoseTrack rest;
  rest.push(0, {});
  return extract_features(scan, deskew(scan, rest, c.body_from_lidar, 0), c);
}

struct TunnelWalk {
  double pitch = 0.0;  ///< [rad] at the end
  std::vector<float> range_bias_m;
};

/// Sixty metres along a bare tunnel. How far along it is, which no scan tells, is taken from the truth.
TunnelWalk walk_tunnel(const std::vector<float>& bias_m, bool learning, RandomStream& noise) {
  constexpr int kScans = 60;
  constexpr double kStep_m = 1.0;
  const BoxWorld tunnel = testing::smooth_tunnel();
  const Calibration c = calibration();
  ScanMatcher matcher(c, {});
  Pose estimate;
  for (int k = 0; k < kScans; ++k) {
    const FeatureCloud features = biased_scan(tunnel, at(kStep_m * k), bias_m, matcher.range_biases(), c, noise);
    estimate.translation.x() = kStep_m * k;
    if (k > 0) {
      estimate = matcher.match(features, loose(estimate)).pose;
      estimate.translation.x() = kStep_m * k;
    }
    matcher.insert(features, estimate, kStep_m * k);
    if (learning) matcher.learn_range_biases(kStep_m);
  }
  return {log_so3(estimate.rotation).y(), matcher.range_biases().metres()};
}

TEST(ScanMatcher, LearnsTheBiasesOfItsRings) {
  double bent = 0.0;
  double bent_learning = 0.0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    RandomStream noise(seed, "lidar");
    const std::vector<float> bias_m = random_biases(noise);
    const TunnelWalk learnt = walk_tunnel(bias_m, true, noise);
    ASSERT_EQ(learnt.range_bias_m.size(), bias_m.size());
    // What all rings share only makes the tunnel wider.
    const auto square_of_own = [&](auto&& bias_of) {
      double sum = 0.0;
      double sum_of_squares = 0.0;
      for (std::size_t ring = 0; ring < bias_m.size(); ++ring) {
        const double bias = bias_of(ring);
        sum += bias;
        sum_of_squares += bias * bias;
      }
      return sum_of_squares - sum * sum / static_cast<double>(bias_m.size());
    };
    const double before = square_of_own([&](std::size_t ring) { return bias_m[ring]; });
    const double left = square_of_own([&](std::size_t ring) { return bias_m[ring] - learnt.range_bias_m[ring]; });
    // A seventh and a fourteenth, of biases of 15 and 12 mm.
    EXPECT_LT(left, 0.25 * before) << seed;
    bent += std::abs(walk_tunnel(bias_m, false, noise).pitch);
    bent_learning += std::abs(learnt.pitch);
  }
  // Without learning 0.3 degrees in 60 m, with it a third of that: what is left is bent while it learns.
  EXPECT_LT(bent_learning, 0.5 * bent);
}

TEST(RangeBiases, OfASingleLaserNothingIsLearnt) {
  const SharedEstimate certain{1.0, 0.01};
  RangeBiases biases(0.01);
  biases.learn({certain}, 1.0);
  EXPECT_TRUE(biases.metres().empty());
  biases.learn({certain, certain}, 1.0);
  ASSERT_EQ(biases.metres().size(), 2U);
  EXPECT_NEAR(biases.metres()[1], 0.01F, 1e-3F);
  EXPECT_LT(biases.sigma_m(1), 0.01);
}

/// In flight above a plain, the lidar looking down at 45 degrees: what the front rings lay down, the rear ones lie on,
/// and where their ranges are biased the map bends with every renewal. A filter that is to trust gravity more than such
/// a map has to be told by how much it may bend.
TEST(ScanMatcher, SaysHowFarBiasesOfItsRingsMayBendTheMap) {
  constexpr int kScans = 60;
  constexpr double kStep_m = 1.5;
  BoxWorld plain;
  plain.boxes.push_back({{-300.0, -300.0, -2.0}, {600.0, 300.0, -1.0}, false});
  Calibration c = calibration();
  c.body_from_lidar = {rotation_from_rpy({0.0, 45.0 * kDegree, 0.0}), {0.0, 0.0, 0.0}};
  double sum_of_squares = 0.0;  // in sigmas
  double sum_of_squared_pitch = 0.0;
  constexpr int kSeeds = 4;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    RandomStream noise(seed, "lidar");
    const std::vector<float> bias_m = random_biases(noise);
    ScanMatcher matcher(c, {});
    Pose estimate{Eigen::Quaterniond::Identity(), {0.0, 0.0, 19.0}};
    double variance = 0.0;
    for (int k = 0; k < kScans; ++k) {
      const Pose truth{Eigen::Quaterniond::Identity(), {kStep_m * k, 0.0, 19.0}};
      const FeatureCloud features = biased_scan(plain, truth, bias_m, matcher.range_biases(), c, noise);
      if (k > 0) {
        estimate.translation.x() += kStep_m;
        estimate = matcher.match(features, loose(estimate)).pose;
        // What the plain does not show is taken from the truth: it is not this test's matter.
        estimate.translation.head<2>() = truth.translation.head<2>();
        variance += matcher.drift().covariance({kStep_m, 0.0, 0.0})(1, 1);
      }
      matcher.insert(features, estimate, kStep_m * k);
    }
    const double pitch = log_so3(estimate.rotation).y();
    sum_of_squares += pitch * pitch / variance;
    sum_of_squared_pitch += pitch * pitch;
  }
  // In sigmas, root mean square: 1.2. Without what each ring does to a renewal it was 5.8.
  EXPECT_LT(std::sqrt(sum_of_squares / kSeeds), 3.0);
  EXPECT_GT(std::sqrt(sum_of_squared_pitch / kSeeds), 1e-4) << "or nothing has bent";
}

/// Trunks that are passed show ever other sides. Each match may err by its noise, but not all of them to one side: what
/// they share becomes drift, a share of it a scan.
TEST(ScanMatcher, PassingTrunksDoesNotPullBackwards) {
  constexpr int kScans = 60;
  constexpr double kStep_m = 0.5;
  const BoxWorld avenue = testing::avenue(kScans * kStep_m);
  RandomStream noise(6, "lidar");
  ScanMatcher matcher(calibration(), {});
  double sum_m = 0.0;
  int matched = 0;
  for (int k = 0; k < kScans; ++k) {
    const Pose truth = at(kStep_m * k);
    const FeatureCloud scan = still_scan(avenue, truth, noise);
    const SolveResult result = matcher.match(scan, loose(truth));
    if (result.spectrum.well_conditioned == 6) {
      sum_m += truth.local(result.pose)[3];
      ++matched;
    }
    matcher.insert(scan, truth, kStep_m * k);
  }
  ASSERT_GT(matched, kScans / 2);
  EXPECT_LT(std::abs(sum_m / matched), 0.4 * kRangeSigma);  // the trunks' nearest sides pull by 0.8 of it
}

/// Ground and leaves: what has neither an edge nor a plane tells where one stands by its points.
TEST(ScanMatcher, LeavesTellWhereOneStands) {
  RandomStream noise(7, "lidar");
  const BoxWorld thicket = testing::thicket(10.0);
  ScanMatcher matcher = mapped(thicket, noise);
  const Pose truth = at(0.6, 0.2, 0.1);
  const SolveResult result = matcher.match(still_scan(thicket, truth, noise), loose(truth.retract(offset(0.1, 1.0))));
  EXPECT_EQ(result.spectrum.well_conditioned, 6);
  const Vector6d error = truth.local(result.pose);
  // Some hundred points, each a decimetre off its partner.
  EXPECT_LT(error.tail<3>().norm(), 0.03);
  EXPECT_LT(error.head<3>().norm(), 0.3 * kDegree);
}

TEST(ScanMatcher, ForcedSixDofSolvesEvenTheAxisOfATunnel) {
  RandomStream noise(6, "lidar");
  const BoxWorld tunnel = testing::smooth_tunnel();
  ScanMatcher matcher = mapped(tunnel, noise, WeakDirections::kForced);
  const SolveResult result = matcher.match(still_scan(tunnel, at(0.6), noise), loose(at(0.55)));
  EXPECT_EQ(result.spectrum.well_conditioned, 6);
}

struct ConditionCase {
  const char* name;
  BoxWorld world;
  int well_conditioned;
};

// The default threshold lies in the gap: an order of magnitude from both sides.
TEST(ScanMatcher, TheThresholdSeparatesTunnelsFromCorridorsWithFrames) {
  BoxWorld plain;
  plain.boxes.push_back({{-200.0, -200.0, -1.2}, {200.0, 200.0, 60.0}, true});
  const double threshold = ScanMatcherConfig{}.degeneracy_threshold;
  const std::vector<ConditionCase> cases = {{"tunnel", testing::smooth_tunnel(), 5},
                                            {"plain", plain, 3},
                                            {"frames every 3 m", testing::framed_corridor(3.0), 6},
                                            {"frames every 5 m", testing::framed_corridor(5.0), 6},
                                            {"room", testing::furnished_room(), 6}};
  for (const ConditionCase& c : cases) {
    SCOPED_TRACE(c.name);
    RandomStream noise(7, c.name);
    ScanMatcher matcher = mapped(c.world, noise);
    const Spectrum s = matcher.match(still_scan(c.world, at(0.6), noise), loose(at(0.6))).spectrum;
    ASSERT_EQ(s.well_conditioned, c.well_conditioned) << s.eigenvalues.transpose();
    EXPECT_GT(s.eigenvalues[6 - c.well_conditioned], 10.0 * threshold);
    if (c.well_conditioned < 6) {
      EXPECT_LT(s.eigenvalues[5 - c.well_conditioned], threshold / 5.0);
    }
  }
}

TEST(ScanMatcher, NothingOlderThanTheMemoryIsMatched) {
  RandomStream noise(8, "lidar");
  const BoxWorld room = testing::furnished_room();
  ScanMatcher matcher(calibration(), {});
  const FeatureCloud scan = still_scan(room, at(0.0), noise);
  matcher.insert(scan, at(0.0), 0.0);
  const std::size_t points = matcher.map().size();
  matcher.insert({}, at(0.0), 299.0);
  EXPECT_EQ(matcher.match(scan, loose(at(0.0))).spectrum.well_conditioned, 6);
  matcher.insert({}, at(0.0), 301.0);
  EXPECT_EQ(matcher.match(scan, loose(at(0.0))).features, 0);
  EXPECT_EQ(matcher.map().size(), points);
}

/// Where gravity has told that the map is bent, the estimate no longer lies where the map has it. Who draws, colours or
/// localizes on the map does so by the estimate.
TEST(ScanMatcher, RecordsTheMapWhereTheEstimateIs) {
  RandomStream noise(8, "lidar");
  const FeatureCloud scan = still_scan(testing::furnished_room(), at(0.0), noise);
  const auto lowest = [](const ScanMatcher& matcher) {
    float z = 0.0F;
    for (const MapPoint& point : matcher.map()) z = std::min(z, point.position.z());
    return z;
  };
  ScanMatcher straight(calibration(), {});
  straight.insert(scan, at(0.0), 0.0);
  ScanMatcher bent(calibration(), {});
  Pose in_map = at(0.0);
  in_map.translation.z() += 4.0;
  bent.insert(scan, in_map, 0.0, at(0.0));
  EXPECT_EQ(lowest(bent), lowest(straight));
  EXPECT_EQ(bent.match(scan, loose(in_map)).spectrum.well_conditioned, 6);
}

TEST(ScanMatcher, IsDeterministic) {
  const auto run = [] {
    RandomStream noise(9, "lidar");
    const BoxWorld room = testing::furnished_room();
    ScanMatcher matcher = mapped(room, noise);
    const Pose pose = matcher.match(still_scan(room, at(0.6), noise), loose(at(0.5))).pose;
    return std::pair(pose.translation, matcher.map().size());
  };
  EXPECT_EQ(run(), run());
}

// Fifty metres with nothing but scans: the guess is the previous motion again, and the same guess de-skews. All of what
// the pipeline adds (IMU, vision) is missing, and the body rolls, pitches and yaws meanwhile.
TEST(ScanMatcher, ScanToMapOdometryDriftsLittleOverFiftyMetres) {
  const BoxWorld hall = testing::pillared_hall(50.0);
  const auto motion = [](double t) {
    return Pose{rotation_from_rpy({0.02 * std::sin(2.0 * t), 0.02 * std::sin(2.5 * t), 0.15 * std::sin(0.7 * t)}),
                {2.0 * t, 0.5 * std::sin(0.5 * t), 0.02 * std::sin(3.0 * t)}};
  };
  const Calibration c = calibration();
  constexpr std::int64_t kPeriod_ns = 100'000'000;
  RandomStream noise(10, "lidar");
  ScanMatcher matcher(c, {});
  Pose before = motion(0.0);
  Pose now = motion(0.1);  // the first scan's end; its motion is given
  Pose guess = now;
  double path_m = 0.0;
  for (int k = 0; k < 250; ++k) {
    const LidarScan scan = testing::vlp16_scan(hall, motion, k * kPeriod_ns, c.body_from_lidar, kRangeSigma, noise);
    PoseTrack track;
    track.push(scan.stamp_ns, k == 0 ? before : now);
    track.push(scan.end_ns, guess);
    const FeatureCloud features = extract_features(scan, deskew(scan, track, c.body_from_lidar, scan.end_ns), c);
    const Pose estimate = k == 0 ? guess : matcher.match(features, {guess, Matrix6d::Identity() * 0.01}).pose;
    if (k > 0) before = now;
    path_m += (estimate.translation - before.translation).norm();
    now = estimate;
    matcher.insert(features, now, path_m);
    guess = now * (before.inverse() * now);
  }
  const Vector6d error = motion(25.0).local(now);
  EXPECT_LT(error.tail<3>().norm(), 0.002 * 50.0);
  RecordProperty("drift_mm", std::to_string(1e3 * error.tail<3>().norm()));
}

}  // namespace
}  // namespace plumbline
