#include "estimator/vision/bundle_adjustment.h"

#include <gtest/gtest.h>

#include "tests/estimator/point_world.h"

namespace plumbline {
namespace {

using testing::hall_points;
using testing::see;
using testing::stereo_calibration;
using testing::walk;

struct Window {
  std::vector<BundleImage> images;
  std::vector<Pose> truth;  ///< world_from_body
};

/// Eight images a sixth of a second apart whose poses have drifted; every third feature has depth good to 2 %.
Window drifted_window(std::uint64_t seed, double range_m = 40.0) {
  const Calibration calibration = stereo_calibration();
  const auto points = hall_points(4.0, seed);
  RandomStream random(seed, "window");
  Window window;
  Pose drift;
  for (int i = 0; i < 8; ++i) {
    const Pose truth = walk(i / 6.0);
    Vector6d wrong = Vector6d::Zero();
    for (int k = 0; k < 6; ++k) wrong[k] = (k < 3 ? 1e-3 : 1e-2) * random.gaussian();
    if (i > 0) drift = drift.retract(wrong);
    BundleImage image{walk(0.0) * drift * walk(0.0).inverse() * truth, {}};
    const PointFrame seen =
        see(points, truth, calibration.body_from_camera, calibration.camera, 0, i, range_m, 0.25, random);
    for (const PointFrame::Point& p : seen.points) {
      FrameToFrame::Sighting sighting{p.id, p.pixel.cast<double>(), 0.25, {}, DepthSource::kNone};
      if (p.id % 3 == 0) {
        const Eigen::Vector3d point =
            (truth * calibration.body_from_camera).inverse() * points[static_cast<std::size_t>(p.id)];
        sighting.depth = {(1.0 + 0.02 * random.gaussian()) / point.z(), 0.02 / point.z()};
        sighting.source = DepthSource::kLidar;
      }
      image.sightings.push_back(sighting);
    }
    window.images.push_back(std::move(image));
    window.truth.push_back(truth);
  }
  return window;
}

double worst_error_m(const Window& window, const std::vector<Pose>& first_from_body) {
  double worst = 0.0;
  for (std::size_t i = 0; i < first_from_body.size(); ++i) {
    const Pose truth = window.truth.front().inverse() * window.truth[i];
    worst = std::max(worst, (truth.translation - first_from_body[i].translation).norm());
  }
  return worst;
}

TEST(BundleAdjustment, RemovesMostOfTheDriftAndLeavesTheFirstImage) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Window window = drifted_window(seed);
    std::vector<Pose> before;
    for (const BundleImage& image : window.images) {
      before.push_back(window.images.front().odometry_from_body.inverse() * image.odometry_from_body);
    }
    const auto after = adjust_bundle(window.images, stereo_calibration(), {});
    ASSERT_TRUE(after.has_value());
    EXPECT_LT(after->front().translation.norm(), 1e-9);
    // Some 10 cm of drift before; a hundred points of 0.25 px noise at 10 m fix a camera to a centimetre or two.
    EXPECT_LT(worst_error_m(window, *after), 0.3 * worst_error_m(window, before)) << "seed " << seed;
    EXPECT_LT(worst_error_m(window, *after), 0.025) << "seed " << seed;
  }
}

TEST(BundleAdjustment, OutlyingDepthsDoNotSpoilIt) {
  Window window = drifted_window(4);
  int spoilt = 0;
  for (BundleImage& image : window.images) {
    for (FrameToFrame::Sighting& s : image.sightings) {
      if (s.source == DepthSource::kLidar && s.id % 30 == 0) {
        s.depth.mean *= 2.0;  // taken from in front of the thing seen
        ++spoilt;
      }
    }
  }
  ASSERT_GT(spoilt, 10);
  const auto after = adjust_bundle(window.images, stereo_calibration(), {});
  ASSERT_TRUE(after.has_value());
  EXPECT_LT(worst_error_m(window, *after), 0.03);
}

TEST(BundleAdjustment, DeclinesWhereTooFewTracksJoinTwoImages) {
  Window window = drifted_window(5);
  EXPECT_TRUE(adjust_bundle(window.images, stereo_calibration(), {}).has_value());
  window.images[4].sightings.resize(10);
  for (std::size_t i = 5; i < window.images.size(); ++i) {
    for (auto& s : window.images[i].sightings) s.id += 1'000'000;
  }
  EXPECT_FALSE(adjust_bundle(window.images, stereo_calibration(), {}).has_value());
  EXPECT_FALSE(adjust_bundle({window.images.front()}, stereo_calibration(), {}).has_value());
}

TEST(BundleAdjustment, IsDeterministic) {
  const Window window = drifted_window(6);
  const auto a = adjust_bundle(window.images, stereo_calibration(), {});
  const auto b = adjust_bundle(window.images, stereo_calibration(), {});
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < a->size(); ++i) EXPECT_EQ((*a)[i].translation, (*b)[i].translation);
}

}  // namespace
}  // namespace plumbline
