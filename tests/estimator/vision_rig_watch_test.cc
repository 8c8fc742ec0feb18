#include "estimator/vision/rig_watch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/geometry/so3.h"

namespace plumbline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const CameraIntrinsics kRigCamera{752, 480, 481.0, 481.0, 375.5, 239.5};

/// A camera that looks along the body's x axis, a metre above its origin.
CameraMotion moved(double yaw, const Vector3d& step_m) {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return camera_motion({exp_so3({0.0, 0.0, yaw}), step_m}, {Eigen::Quaterniond(axes), {0.0, 0.0, 1.0}});
}

FeatureSighting seen_at(const Vector2d& reference, const Vector2d& now) {
  FeatureSighting sighting;
  sighting.keyframe_ray = ray_through(kRigCamera, reference);
  sighting.pixel = now;
  sighting.pixel_sigma = 0.3;
  sighting.depth = {0.0, 0.3};  // unknown, far away
  return sighting;
}

/// Where the camera sees a point now that the reference saw at a pixel and a depth.
Vector2d follows(const CameraMotion& motion, const Vector2d& reference, double depth_m) {
  return project(kRigCamera, motion.camera_from_keyframe_rotation * ray_through(kRigCamera, reference) +
                                 motion.camera_from_keyframe_translation / depth_m);
}

// A tenth of a second of a motorway's bend: 2 m ahead, 2 mrad, one pixel.
const CameraMotion kBend = moved(2e-3, {2.0, 0.0, 0.0});
const Vector2d kBonnet(380.0, 430.0);

int images_until_found(const CameraMotion& motion, const FeatureSighting& sighting) {
  RidingEvidence evidence;
  for (int k = 1; k <= 100; ++k) {
    evidence.add(evidence_of_riding(motion, kRigCamera, sighting));
    if (evidence.rides()) return k;
  }
  return 0;
}

TEST(RigWatch, FindsABonnetWithinASecondOfABend) {
  const int images = images_until_found(kBend, seen_at(kBonnet, kBonnet));
  EXPECT_GE(images, 2);  // one image may err
  EXPECT_LE(images, 10);
}

TEST(RigWatch, WhatStandsInTheWorldNeverRides) {
  for (const Vector2d& reference : {Vector2d(380, 430), Vector2d(100, 300), Vector2d(376, 230), Vector2d(700, 245)}) {
    for (const double depth_m : {4.0, 20.0, 100.0, 1e6}) {
      const Vector2d now = follows(kBend, reference, depth_m);
      EXPECT_EQ(images_until_found(kBend, seen_at(reference, now)), 0) << reference.transpose() << ", " << depth_m;
      FeatureSighting ranged = seen_at(reference, now);
      ranged.depth = {1.0 / depth_m, 0.01 / depth_m};
      EXPECT_EQ(images_until_found(kBend, ranged), 0) << reference.transpose() << ", " << depth_m << ", known";
    }
  }
}

/// A camera that circles a point keeps it in view: there the turn and the step undo each other, as they may for a point
/// of the world.
TEST(RigWatch, APointThatIsCircledDoesNotRide) {
  const double radius_m = 5.0, angle = 0.02;
  const CameraMotion circling = moved(angle, {radius_m * (1.0 - std::cos(angle)), -radius_m * std::sin(angle), 0.0});
  const Vector2d centre(375.5, 239.5);
  const Vector2d now = follows(circling, centre, radius_m);
  ASSERT_LT((now - centre).norm(), 0.01);
  EXPECT_EQ(images_until_found(circling, seen_at(centre, now)), 0);
}

TEST(RigWatch, StraightAheadAndAtRestNothingIsSaid) {
  EXPECT_EQ(evidence_of_riding(moved(0.0, {2.0, 0.0, 0.0}), kRigCamera, seen_at(kBonnet, kBonnet)), 0.0);
  EXPECT_EQ(evidence_of_riding(moved(0.0, Vector3d::Zero()), kRigCamera, seen_at(kBonnet, kBonnet)), 0.0);
}

TEST(RigWatch, PlacesAreForgotten) {
  RiddenPlaces places;
  places.add(1, {10.0F, 10.0F});
  places.add(5, {20.0F, 20.0F});
  places.forget_before(5);
  ASSERT_EQ(places.pixels().size(), 1U);
  EXPECT_EQ(places.pixels().front().x(), 20.0F);
}

}  // namespace
}  // namespace plumbline
