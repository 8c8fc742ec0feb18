#include "estimator/localization/agreement_gate.h"

#include <gtest/gtest.h>

#include "estimator/geometry/so3.h"
#include "estimator/localization/map_localizer.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

MatchEvidence good_match(const Pose& map_from_body) {
  MatchEvidence evidence;
  evidence.map_from_body = map_from_body;
  evidence.well_conditioned = 6;
  evidence.overlap = evidence.support = evidence.inlier_share = 1.0;
  return evidence;
}

MatchEvidence nothing_there(const Pose& map_from_body) {
  MatchEvidence evidence = good_match(map_from_body);
  evidence.support = 0.0;
  return evidence;
}

Pose moved(double metres) { return {Eigen::Quaterniond::Identity(), {metres, 0.0, 0.0}}; }
Pose turned(double radians) { return {Eigen::Quaterniond(exp_so3({0.0, 0.0, radians})), Eigen::Vector3d::Zero()}; }

/// Over a field nothing agrees for a while; what agrees next has to lie where odometry can have gone since, not within
/// the metre and ten degrees of a start.
TEST(AgreementGate, WhereItWasLostABodyIsSoughtNoFurtherThanOdometryDrifts) {
  AgreementGate gate(Pose{}, {});
  gate.judge(good_match(Pose{}), {});
  ASSERT_EQ(gate.judge(good_match(Pose{}), {}), MapAgreement::kAgrees);
  for (const double metres : {10.0, 20.0, 30.0}) gate.judge(nothing_there(moved(metres)), {moved(metres)});
  ASSERT_FALSE(gate.localized());
  EXPECT_EQ(gate.judge(good_match(moved(40.0) * turned(0.03)), {moved(40.0)}), MapAgreement::kTooFar);
  // Odometry's four sigma: 1.7 m and 0.3 degrees.
  EXPECT_EQ(gate.judge(good_match(moved(40.5) * turned(0.003)), {moved(40.0)}), MapAgreement::kUnconfirmed);
}

/// Without images heading drifts ten times more, and a body that was lost so has to be found again.
TEST(AgreementGate, WithoutImagesAHeadingMayDriftTenTimesMore) {
  AgreementGate gate(Pose{}, {});
  gate.judge(good_match(Pose{}), {});
  ASSERT_EQ(gate.judge(good_match(Pose{}), {}), MapAgreement::kAgrees);
  EXPECT_EQ(gate.judge(good_match(moved(40.0) * turned(0.03)), {moved(40.0), 10.0}), MapAgreement::kTooFar);
  EXPECT_EQ(gate.judge(good_match(moved(40.0) * turned(0.03)), {moved(40.0), 40.0}), MapAgreement::kAgrees);
}

TEST(AgreementGate, AtTheStartAMetreAndTenDegreesAreAllowed) {
  AgreementGate gate(Pose{}, {});
  EXPECT_EQ(gate.judge(good_match(moved(0.8) * turned(0.1)), {}), MapAgreement::kUnconfirmed);
  EXPECT_EQ(gate.judge(good_match(moved(2.0)), {}), MapAgreement::kTooFar);
}

TEST(AgreementGate, OnceFoundLessSupportWillDo) {
  AgreementGate gate(Pose{}, {0.35, 0.03});
  MatchEvidence weak = good_match(Pose{});
  weak.support = 0.1;
  EXPECT_EQ(gate.judge(weak, {}), MapAgreement::kDisagrees);
  gate.judge(good_match(Pose{}), {});
  gate.judge(good_match(Pose{}), {});
  EXPECT_EQ(gate.judge(weak, {}), MapAgreement::kAgrees);
}

void add_wall(std::vector<FeaturePoint>& planes, const Eigen::Vector3f& corner, const Eigen::Vector3f& along,
              const Eigen::Vector3f& up, const Eigen::Vector3f& normal) {
  for (float a = 0.0F; a < 1.0F; a += 0.02F) {
    for (float b = 0.0F; b < 1.0F; b += 0.05F) {
      FeaturePoint f;
      f.position = corner + a * along + b * up;
      f.normal = normal;
      planes.push_back(f);
    }
  }
}

void add_leaves(std::vector<FeaturePoint>& planes, int count, std::uint64_t seed) {
  RandomStream random(seed, "leaves");
  for (int i = 0; i < count; ++i) {
    FeaturePoint f;
    f.position =
        Eigen::Vector3f(static_cast<float>(6.0 + 2.0 * random.uniform()),
                        static_cast<float>(4.0 * random.uniform() - 2.0), static_cast<float>(random.uniform()));
    f.normal = Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).normalized().cast<float>();
    planes.push_back(f);
  }
}

/// A leaf has a normal, but a second look does not find it: that the map does not bear it out says nothing of the map.
TEST(MapLocalizer, FoliageDoesNotSpeakAgainstAMap) {
  const auto place = [](std::uint64_t seed) {
    FeatureCloud cloud;
    add_wall(cloud.planes, {-8, -8, -1}, {16, 0, 0}, {0, 16, 0}, Eigen::Vector3f::UnitZ());  // the ground
    add_wall(cloud.planes, {4, -4, -1}, {0, 2.5, 0}, {0, 0, 1}, -Eigen::Vector3f::UnitX());
    add_wall(cloud.planes, {2, 5, -1}, {2.5, 0, 0}, {0, 0, 1}, -Eigen::Vector3f::UnitY());
    add_leaves(cloud.planes, 6000, seed);
    return cloud;
  };
  PriorMap map;
  map.surfaces = place(1);
  Calibration calibration;
  calibration.has_lidar = true;
  MapLocalizer localizer(calibration, map, Pose{}, true);
  const MapFix first = localizer.locate(0, place(2), {});
  const MapFix second = localizer.locate(2'000'000'000, place(3), {});
  EXPECT_EQ(first.match.agreement, MapAgreement::kUnconfirmed);
  EXPECT_EQ(second.match.agreement, MapAgreement::kAgrees);
}

}  // namespace
}  // namespace plumbline
