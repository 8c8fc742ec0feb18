#include "sensors/lidar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "estimator/geometry/so3.h"
#include "tools/verify/deskew_check.h"

namespace plumbline {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::int64_t kStart_ns = 1'000'000'000;
constexpr std::size_t kFirings = 1808 * 16 + 11;  // of 55.296 us in 0.1 s; the last cycle goes on in the next message
const Eigen::Vector3d kRoomHalfSize(4.0, 3.0, 2.0);

World world_of(const std::string& geoms, float reflectivity = 0.5F) {
  SceneDescription scene;
  scene.mjcf =
      "<mujoco><asset><material name=\"wall\"/></asset><default><geom material=\"wall\"/></default><worldbody>" +
      geoms + "</worldbody></mujoco>";
  Material wall;
  wall.name = "wall";
  wall.lidar_reflectivity = reflectivity;
  scene.materials = {wall};
  return World::from_scene(scene, 1);
}

// Seen from inside.
World room(const std::string& more_geoms = "") { return world_of(R"(<geom type="box" size="4 3 2"/>)" + more_geoms); }

double distance_to_room(const Eigen::Vector3d& point) {
  return (kRoomHalfSize - point.cwiseAbs()).cwiseAbs().minCoeff();
}

double range_to_room(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double range = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) continue;
    range = std::min(range, (std::copysign(kRoomHalfSize[axis], direction[axis]) - origin[axis]) / direction[axis]);
  }
  return range;
}

PoseTrack at_rest(const Pose& world_from_body = {}) {
  PoseTrack track;
  track.push(0, world_from_body);
  track.push(100'000'000'000, world_from_body);
  return track;
}

Lidar ideal_vlp16(const Pose& body_from_lidar = {}) { return Lidar(vlp16(), body_from_lidar, 1, LidarEffects::none()); }

LidarScan scan_at_rest(const Lidar& lidar, const World& world, std::int64_t scan_index = 0) {
  const RayScene rays(world);
  return lidar.scan({world, rays}, at_rest(), kStart_ns, scan_index);
}

struct Beam {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
};

// From the data sheet alone, not from LidarModel: rings 2 degrees apart, origins by the tangent of the elevation
// (41.8 mm, which gives the tabulated offsets to 0.1 mm), clockwise from behind.
Beam vlp16_beam(const LidarPoint& point) {
  const double elevation = (2.0 * point.ring - 15.0) * kPi / 180.0;
  const double azimuth = kPi - 2.0 * kPi * point.offset_ns / 1e8;
  return {{0.0, 0.0, -0.0418 * std::tan(elevation)},
          {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)}};
}

bool same_points(const LidarScan& a, const LidarScan& b) {
  return std::equal(
      a.points.begin(), a.points.end(), b.points.begin(), b.points.end(), [](const LidarPoint& p, const LidarPoint& q) {
        return p.position == q.position && p.offset_ns == q.offset_ns && p.ring == q.ring && p.intensity == q.intensity;
      });
}

TEST(Lidar, EveryFiringOfTheVlp16ReturnsAtItsOwnTimeInFiringOrder) {
  const LidarScan scan = scan_at_rest(ideal_vlp16(), room());
  EXPECT_EQ(scan.stamp_ns, kStart_ns);
  EXPECT_EQ(scan.end_ns, kStart_ns + 100'000'000);
  ASSERT_EQ(scan.points.size(), kFirings);
  const std::array<int, 16> ring_of_laser = {0, 8, 1, 9, 2, 10, 3, 11, 4, 12, 5, 13, 6, 14, 7, 15};
  for (int i = 0; i < static_cast<int>(kFirings); ++i) {
    const LidarPoint& point = scan.points[static_cast<std::size_t>(i)];
    ASSERT_EQ(point.offset_ns, (i / 16) * 55296 + (i % 16) * 2304);
    ASSERT_EQ(point.ring, ring_of_laser[static_cast<std::size_t>(i % 16)]);
  }
}

TEST(Lidar, RangesInARoomMatchTheClosedForm) {
  for (const LidarPoint& point : scan_at_rest(ideal_vlp16(), room()).points) {
    const Beam beam = vlp16_beam(point);
    const Eigen::Vector3d expected = beam.origin + range_to_room(beam.origin, beam.direction) * beam.direction;
    // Offsets are tabulated to 0.1 mm, which a wall 4 m away at 15 degrees keeps below 0.2 mm.
    ASSERT_LE((point.position.cast<double>() - expected).norm(), 3e-4) << "ring " << point.ring;
  }
}

TEST(Lidar, RangesFromTheModelsOwnOriginsAreExact) {
  LidarModel model = vlp16();
  for (LidarBeam& beam : model.beams) beam.vertical_offset_m = 0.0;
  const Lidar lidar(model, Pose{}, 1, LidarEffects::none());
  for (const LidarPoint& point : scan_at_rest(lidar, room()).points) {
    const Beam beam = vlp16_beam(point);
    const double expected = range_to_room(Eigen::Vector3d::Zero(), beam.direction);
    ASSERT_NEAR(point.position.norm(), expected, 1e-5);
    ASSERT_LE((point.position.cast<double>() - expected * beam.direction).norm(), 1e-5);
  }
}

TEST(Lidar, TurnsClockwiseSeenFromAboveFromStraightBehind) {
  const LidarScan scan = scan_at_rest(ideal_vlp16(), room());
  const auto nearly_level = [&](std::int32_t after_ns) {
    return std::find_if(scan.points.begin(), scan.points.end(),
                        [&](const LidarPoint& p) { return p.offset_ns >= after_ns && p.ring == 8; })
        ->position;
  };
  EXPECT_NEAR(nearly_level(0).x(), -4.0F, 1e-3F);
  EXPECT_NEAR(nearly_level(25'000'000).y(), 3.0F, 1e-3F);
  EXPECT_NEAR(nearly_level(50'000'000).x(), 4.0F, 1e-3F);
  EXPECT_NEAR(nearly_level(75'000'000).y(), -3.0F, 1e-3F);
}

TEST(Lidar, ReturnsOfAMovingRigLieOnTheWallsAtTheirOwnPoses) {
  const World world = room();
  const Pose body_from_lidar{exp_so3({0.1, -0.2, 0.3}), {0.2, 0.1, -0.1}};
  Pose world_from_body{exp_so3({0.0, 0.1, 0.5}), {-0.5, 0.3, 0.1}};
  PoseTrack track;
  for (std::int64_t stamp_ns = kStart_ns; stamp_ns <= kStart_ns + 100'000'000; stamp_ns += 5'000'000) {
    track.push(stamp_ns, world_from_body);
    world_from_body.translation += Eigen::Vector3d(5.0, -3.0, 1.0) * 5e-3;
    world_from_body.rotation = world_from_body.rotation * exp_so3(Eigen::Vector3d(1.0, -2.0, 4.0) * 5e-3);
  }
  const RayScene rays(world);
  const LidarScan scan = ideal_vlp16(body_from_lidar).scan({world, rays}, track, kStart_ns, 0);
  ASSERT_EQ(scan.points.size(), kFirings);
  double worst = 0.0;
  double worst_if_rigid = 0.0;
  for (const LidarPoint& point : scan.points) {
    const Eigen::Vector3d in_body = body_from_lidar * point.position.cast<double>();
    worst = std::max(worst, distance_to_room(track.at(kStart_ns + point.offset_ns) * in_body));
    worst_if_rigid = std::max(worst_if_rigid, distance_to_room(track.at(kStart_ns) * in_body));
  }
  EXPECT_LE(worst, 2e-5);
  EXPECT_GE(worst_if_rigid, 0.3) << "the motion should have distorted the scan";
}

TEST(Lidar, ANoiseFreeScanAt370DegreesPerSecondIsTrueToAMillimetreOnceDeskewed) {
  const DeskewCheck check = check_deskew(vlp16());
  EXPECT_GT(check.points, 115'000U);
  EXPECT_LE(check.worst_m, 1e-3);
  EXPECT_GT(check.raw_percentile_m, 0.3);
}

TEST(Lidar, RangesAreMultiplesOfTheResolution) {
  LidarModel model = vlp16();
  for (LidarBeam& beam : model.beams) beam.vertical_offset_m = 0.0;
  for (const LidarPoint& point : scan_at_rest(Lidar(model, Pose{}, 1), room()).points) {
    const double steps = point.position.cast<double>().norm() / 0.002;
    ASSERT_NEAR(steps, std::round(steps), 1e-3);
  }
}

TEST(Lidar, RingBiasIsConstantPerLaserAndOfTheModelsSize) {
  LidarModel model = vlp16();
  model.ring_bias_sigma_m = 0.02;
  LidarEffects bias_only = LidarEffects::none();
  bias_only.ring_bias = true;
  const LidarScan biased = scan_at_rest(Lidar(model, Pose{}, 3, bias_only), room());
  const LidarScan ideal = scan_at_rest(ideal_vlp16(), room());
  std::map<int, double> bias;
  double sum_of_squares = 0.0;
  for (std::size_t i = 0; i < ideal.points.size(); ++i) {
    const double error = (biased.points[i].position - ideal.points[i].position)
                             .cast<double>()
                             .dot(vlp16_beam(ideal.points[i]).direction);
    const auto [known, is_new] = bias.emplace(ideal.points[i].ring, error);
    ASSERT_NEAR(error, known->second, 1e-5);
    if (is_new) sum_of_squares += error * error;
  }
  ASSERT_EQ(bias.size(), 16U);
  EXPECT_NEAR(std::sqrt(sum_of_squares / 16.0), 0.02, 0.012);
}

TEST(Lidar, AScanDoesNotDependOnTheScansBeforeIt) {
  const World world = room();
  const Lidar one(vlp16(), Pose{}, 5);
  const Lidar other(vlp16(), Pose{}, 5);
  scan_at_rest(one, world, 0);
  const LidarScan after_another = scan_at_rest(one, world, 1);
  EXPECT_TRUE(same_points(after_another, scan_at_rest(other, world, 1)));
  EXPECT_FALSE(same_points(after_another, scan_at_rest(other, world, 0)));
  EXPECT_FALSE(same_points(after_another, scan_at_rest(Lidar(vlp16(), Pose{}, 6), world, 1)));
}

TEST(Lidar, AnotherSurfaceLeavesTheNoiseOfTheRestAsItWas) {
  const World bare = room();
  // Within the least range, so that it takes returns away.
  const World with_ball = room(R"(<geom type="sphere" size="0.1" pos="0.2 0 0"/>)");
  LidarEffects effects;
  effects.mixed_pixels = false;  // the ball's rim is in some of the beams that pass it
  const Lidar lidar(vlp16(), Pose{}, 5, effects);
  const LidarScan all = scan_at_rest(lidar, bare);
  const LidarScan fewer = scan_at_rest(lidar, with_ball);
  ASSERT_LT(fewer.points.size(), all.points.size());
  auto next = all.points.begin();
  for (const LidarPoint& point : fewer.points) {
    while (next->offset_ns != point.offset_ns) ++next;
    ASSERT_EQ(point.position, next->position);
  }
}

TEST(Lidar, OnlyRangesWithinTheLimitsReturn) {
  LidarModel model = vlp16();
  model.min_range_m = 3.5;
  model.max_range_m = 4.5;
  const LidarScan scan = scan_at_rest(Lidar(model, Pose{}, 1), room());
  EXPECT_GT(scan.points.size(), 1000U);
  EXPECT_LT(scan.points.size(), kFirings);
  for (const LidarPoint& point : scan.points) {
    const double range = (point.position.cast<double>() - vlp16_beam(point).origin).norm();
    ASSERT_GE(range, 3.5 - 1e-3);
    ASSERT_LE(range, 4.5 + 1e-3);
  }
}

TEST(Lidar, ANearSurfaceHidesWhatIsBehindIt) {
  const LidarScan scan = scan_at_rest(ideal_vlp16(), room(R"(<geom type="sphere" size="0.3"/>)"));
  EXPECT_TRUE(scan.points.empty());
}

// A wall square to x, level beams only.
std::size_t returns_from_wall(double distance_m, float reflectivity) {
  const World world = world_of(
      "<geom type=\"box\" size=\"0.1 1 5\" pos=\"" + std::to_string(distance_m + 0.1) + " 0 0\"/>", reflectivity);
  LidarEffects effects;
  effects.mixed_pixels = false;  // half of a beam is lost beside the wall
  return scan_at_rest(Lidar(vlp16(), Pose{}, 1, effects), world).points.size();
}

TEST(Lidar, SeesATenPercentTargetToFiftyMetresAndAnEightyPercentOneToTheEndOfItsRange) {
  // The signal falls with the square of the distance: certain at half as far, hopeless half as far again.
  const std::size_t all = returns_from_wall(35.0, 0.8F);
  EXPECT_EQ(returns_from_wall(35.0, 0.1F), all);
  EXPECT_GT(returns_from_wall(50.0, 0.1F), 0U);
  EXPECT_LT(returns_from_wall(50.0, 0.1F), returns_from_wall(50.0, 0.8F));
  EXPECT_EQ(returns_from_wall(75.0, 0.1F), 0U);
  EXPECT_GT(returns_from_wall(98.0, 0.8F), 0U);
  EXPECT_EQ(returns_from_wall(101.0, 0.8F), 0U);
}

TEST(Lidar, IntensityIsReflectivityTimesTheCosineOfIncidence) {
  for (const LidarPoint& point : scan_at_rest(ideal_vlp16(), room()).points) {
    const Eigen::Vector3d slack = kRoomHalfSize - point.position.cast<double>().cwiseAbs();
    if ((slack.array() < 1e-2).count() != 1) continue;  // near an edge either wall may be the one
    Eigen::Index axis = 0;
    slack.minCoeff(&axis);
    ASSERT_NEAR(point.intensity, 0.5 * std::abs(vlp16_beam(point).direction[axis]), 1e-5);
  }
}

TEST(Lidar, RefusesAMotionThatDoesNotCoverTheRevolution) {
  const World world = room();
  PoseTrack track;
  track.push(kStart_ns, Pose{});
  track.push(kStart_ns + 50'000'000, Pose{});
  const RayScene rays(world);
  EXPECT_THROW(ideal_vlp16().scan({world, rays}, track, kStart_ns, 0), std::invalid_argument);
}

TEST(LidarModel, RefusesEachFieldOutOfRangeByName) {
  const auto expect_refused = [](const std::string& field, const auto& spoil) {
    LidarModel model = vlp16();
    spoil(model);
    EXPECT_THAT([&] { validate_or_throw(model); },
                ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr(field)));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  validate_or_throw(vlp16());
  expect_refused("beams' number", [](LidarModel& m) { m.beams.clear(); });
  expect_refused("elevation_deg[3]", [](LidarModel& m) { m.beams[3].elevation_deg = 90.0; });
  expect_refused("azimuth_deg[4]", [&](LidarModel& m) { m.beams[4].azimuth_deg = nan; });
  expect_refused("vertical_offset_m[0]", [&](LidarModel& m) { m.beams[0].vertical_offset_m = nan; });
  expect_refused("firing_s[15]", [](LidarModel& m) { m.beams[15].firing_s = 60e-6; });
  expect_refused("firing_s[2]", [](LidarModel& m) { m.beams[2].firing_s = 1e-6; });
  expect_refused("cycle_s", [](LidarModel& m) { m.head = SpinningHead{0.0}; });
  expect_refused("columns", [](LidarModel& m) { m.head = ColumnHead{0, 0.0}; });
  expect_refused("beams' number", [](LidarModel& m) { m.head = TwoAxisHead{}; });
  expect_refused("rate_hz", [&](LidarModel& m) { m.rate_hz = nan; });
  expect_refused("encoder_resolution_deg", [](LidarModel& m) { m.encoder_resolution_deg = -1.0; });
  expect_refused("min_range_m", [](LidarModel& m) { m.min_range_m = -1.0; });
  expect_refused("max_range_m", [](LidarModel& m) { m.max_range_m = m.min_range_m; });
  expect_refused("range_at_10_percent_m", [](LidarModel& m) { m.range_at_10_percent_m = 0.0; });
  expect_refused("range_sigma_m", [](LidarModel& m) { m.range_sigma_m = -0.1; });
  expect_refused("range_sigma_at_limit_m", [&](LidarModel& m) { m.range_sigma_at_limit_m = nan; });
  expect_refused("range_resolution_m", [&](LidarModel& m) { m.range_resolution_m = nan; });
  expect_refused("ring_bias_sigma_m", [](LidarModel& m) { m.ring_bias_sigma_m = -0.1; });
  expect_refused("pulse_s", [](LidarModel& m) { m.pulse_s = 0.0; });
  expect_refused("divergence_vertical_rad", [](LidarModel& m) { m.divergence_vertical_rad = 0.0; });
}

TEST(LidarModel, RefusesLinesThatDoNotFillMessagesAndSweeps) {
  LidarModel model;
  model.beams = {{}};
  model.head = TwoAxisHead{};
  validate_or_throw(model);
  EXPECT_EQ(ring_count(model), 40);
  EXPECT_EQ(messages_per_sweep(model), 10);
  model.rate_hz = 7.0;
  EXPECT_THROW(validate_or_throw(model), std::invalid_argument);
  model.rate_hz = 10.0;
  model.head = TwoAxisHead{.joint_deg_per_s = 77.0};
  EXPECT_THROW(validate_or_throw(model), std::invalid_argument);
}

}  // namespace
}  // namespace plumbline
