#include "estimator/vision/visual_odometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "estimator/geometry/so3.h"
#include "tests/estimator/vision_scene.h"

namespace plumbline {
namespace {

using Eigen::Vector3d;
using testing::textured_plane;
using testing::TexturedPlane;

constexpr double kFrameS = 0.02;

std::vector<TexturedPlane> room() {
  return {textured_plane({9, 0, 0}, {0, -1, 0}, {0, 0, -1}, 24, 14, 0.012, 1),
          textured_plane({6, 3, 0}, Vector3d(0.6, -0.8, 0), {0, 0, -1}, 4, 10, 0.01, 2),
          textured_plane({5, -2, -0.5}, Vector3d(0.2, -1, 0).normalized(), {0, 0, -1}, 2, 2, 0.008, 3)};
}

Matrix6d prior_covariance() {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(2e-3 * 2e-3), Eigen::Vector3d::Constant(1e-2 * 1e-2);
  return covariance;
}

/// What a lens makes of a pinhole's image.
cv::Mat through_lens(const cv::Mat& pinhole, const cv::Mat& places) {
  if (places.empty()) return pinhole;
  cv::Mat image;
  cv::remap(pinhole, image, places, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return image;
}

/// Where in a pinhole's image each pixel looks; empty without distortion.
cv::Mat pinhole_places(const CameraIntrinsics& camera) {
  if (camera.distortion.none()) return {};
  cv::Mat places(camera.height, camera.width, CV_32FC2);
  for (int v = 0; v < places.rows; ++v) {
    for (int u = 0; u < places.cols; ++u) {
      const Eigen::Vector2d ideal =
          undistort(camera.distortion, {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy});
      places.at<cv::Vec2f>(v, u) = {static_cast<float>(camera.fx * ideal.x() + camera.cx),
                                    static_cast<float>(camera.fy * ideal.y() + camera.cy)};
    }
  }
  return places;
}

/// Drives a VisualOdometry over the room as the pipeline does. The prior is the true motion of one frame, wrong by
/// some 1 mm and 0.2 mrad, from the last estimate.
class Drive {
 public:
  using Path = std::function<Pose(double time_s)>;

  explicit Drive(Path path, const VisionConfig& config = {}, const LensDistortion& lens = {})
      : world_from_body(path),
        calibration(calibration_with(lens)),
        odometry(calibration, config),
        estimate(path(0.0)) {}

  static Calibration calibration_with(const LensDistortion& lens) {
    Calibration seen_through = testing::vision_calibration();
    seen_through.camera.distortion = lens;
    return seen_through;
  }

  struct Light {
    double gain = 1.0;
    double noise_dn = 1.0;
  };

  SolveResult step(const Light& light, bool with_lidar = true) {
    const double time_s = kFrameS * frame;
    const auto stamp_ns = static_cast<std::int64_t>(frame) * 20'000'000;
    const Pose truth = world_from_body(time_s);
    if (with_lidar && frame % 5 == 0) {
      auto points = testing::lidar_points(planes, truth, 0.015, noise);
      for (Eigen::Vector3f& p : points) p = (truth.inverse() * p.cast<double>()).cast<float>();
      odometry.add_depth_points(stamp_ns, points, truth);
    }
    const Pose increment = frame == 0 ? Pose{} : world_from_body(time_s - kFrameS).inverse() * truth;
    Vector6d wrong = Vector6d::Zero();
    for (int i = 0; frame > 0 && i < 6; ++i) wrong[i] = (i < 3 ? 2e-4 : 1e-3) * noise.gaussian();
    const PosePrior prior{(keyframe.inverse() * estimate * increment).retract(wrong), prior_covariance()};
    const CameraFrame image = testing::expose(through_lens(testing::draw(planes, calibration, truth), lens_places),
                                              stamp_ns, light.gain, light.noise_dn, noise);
    const SolveResult result = odometry.process(image, prior);
    estimate = keyframe * result.pose;
    true_keyframe_from_body = true_keyframe.inverse() * truth;
    if (odometry.wants_keyframe()) {
      odometry.start_keyframe(estimate, (true_keyframe.inverse() * truth).rotation);
      keyframe = estimate;
      true_keyframe = truth;
    }
    ++frame;
    return result;
  }

  double error_m() const { return (estimate.translation - world_from_body(kFrameS * (frame - 1)).translation).norm(); }

  Path world_from_body;
  Calibration calibration;
  cv::Mat lens_places = pinhole_places(calibration.camera);
  std::vector<TexturedPlane> planes = room();
  VisualOdometry odometry;
  RandomStream noise{5, "drive"};
  Pose estimate;
  Pose keyframe = estimate;
  Pose true_keyframe = estimate;
  Pose true_keyframe_from_body;
  int frame = 0;
};

Pose forward(double t) { return {Eigen::Quaterniond::Identity(), Vector3d(t, 0, 0)}; }
Pose sideways(double t) { return {Eigen::Quaterniond::Identity(), Vector3d(0, t, 0)}; }
Pose weaving(double t) {
  return {exp_so3(Vector3d(0.05 * std::sin(2 * t), 0.05 * std::sin(3 * t), 0.3 * std::sin(t))),
          Vector3d(0.7 * t, 0.7 * t * std::cos(0.5 * t), 0.1 * std::sin(2 * t))};
}
Pose resting(double) { return Pose{}; }

TEST(VisualOdometry, DriftsLessThanThreeThousandthsOfTheDistanceWithLidarDepth) {
  for (const Drive::Path& path : {Drive::Path(forward), Drive::Path(sideways), Drive::Path(weaving)}) {
    Drive drive(path);
    double distance = 0.0;
    while (distance < 2.0) {
      drive.step({});
      const double t = kFrameS * drive.frame;
      distance += (path(t).translation - path(t - kFrameS).translation).norm();
    }
    EXPECT_LT(drive.error_m(), 0.003 * distance);
  }
}

// A pincushion of 20 px in the corners, whose images lie wholly within the pinhole's.
TEST(VisualOdometry, DriftsNoMoreThroughALensThatDistorts) {
  for (const Drive::Path& path : {Drive::Path(forward), Drive::Path(weaving)}) {
    Drive drive(path, {}, {0.08, 0.01, 0.002, -0.001});
    double distance = 0.0;
    while (distance < 2.0) {
      drive.step({});
      const double t = kFrameS * drive.frame;
      distance += (path(t).translation - path(t - kFrameS).translation).norm();
    }
    EXPECT_LT(drive.error_m(), 0.003 * distance);
  }
}

TEST(VisualOdometry, DeterminesAllSixDirectionsWithLidarDepthInGoodLight) {
  Drive drive(forward);
  drive.step({});
  for (int i = 0; i < 60; ++i) EXPECT_EQ(drive.step({}).spectrum.well_conditioned, 6) << "frame " << i;
}

TEST(VisualOdometry, InformationIsHonest) {
  double sum = 0.0;
  int solves = 0;
  for (const Drive::Path& path : {Drive::Path(forward), Drive::Path(weaving)}) {
    Drive drive(path);
    drive.step({});
    for (int i = 0; i < 70; ++i) {
      const SolveResult result = drive.step({});
      const Vector6d error = drive.true_keyframe_from_body.local(result.pose);
      sum += error.dot(result.information * error) / 6.0;
      ++solves;
    }
  }
  // Errors within a key-frame are alike, so this averages few independent draws: a factor of three either way.
  EXPECT_GT(sum / solves, 0.3);
  EXPECT_LT(sum / solves, 3.0);
}

TEST(VisualOdometry, FollowsAutoExposure) {
  Drive drive(sideways);
  for (int i = 0; i < 60; ++i) drive.step({1.0 - 0.006 * i, 1.0});
  EXPECT_LT(drive.error_m(), 0.003 * 1.2);
}

TEST(VisualOdometry, TriangulatesWhatTheLidarDoesNotSee) {
  Drive drive(sideways);
  for (int i = 0; i < 80; ++i) drive.step({}, /*with_lidar=*/i < 1);
  int triangulated = 0;
  for (const TrackedFeature& f : drive.odometry.features()) {
    triangulated += f.depth == TrackedFeature::Depth::kTriangulated ? 1 : 0;
  }
  EXPECT_GT(triangulated, 20);
  EXPECT_LT(drive.error_m(), 0.01 * 1.6);
}

TEST(VisualOdometry, StandsAsideInTheDarkAndReturnsWithTheLight) {
  Drive drive(forward);
  for (int i = 0; i < 30; ++i) drive.step({});
  int dark_solved = 0;
  for (int i = 0; i < 50; ++i) dark_solved += drive.step({0.0, 1.4}).spectrum.well_conditioned > 0 ? 1 : 0;
  EXPECT_LE(dark_solved, 2);
  int frames_until_solved = 0;
  while (frames_until_solved < 50 && drive.step({}).spectrum.well_conditioned < 6) ++frames_until_solved;
  EXPECT_LT(frames_until_solved, 15);  // 0.3 s: one retry interval and a frame to track, with margin; 1 s is the limit
}

TEST(VisualOdometry, SeesNothingInNoiseFromTheStart) {
  Drive drive(forward);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(drive.step({0.0, 3.0}).spectrum.well_conditioned, 0);
  EXPECT_TRUE(drive.odometry.features().empty());
}

TEST(VisualOdometry, RestWithoutAnyDepthClaimsNoTranslationAndStaysPut) {
  Drive drive(resting);
  for (int i = 0; i < 100; ++i) {
    const SolveResult result = drive.step({}, /*with_lidar=*/false);
    ASSERT_TRUE(result.pose.translation.allFinite());
    // Rotation shows in every feature; translation, at rest and without depth, in none.
    if (i > 0) {
      EXPECT_EQ(result.spectrum.well_conditioned, 3);
    }
  }
  EXPECT_LT(log_so3(drive.estimate.rotation).norm(), 1e-3);
}

TEST(VisualOdometry, AnOddFrameIsAnOrdinaryResultWithNothingSolved) {
  VisualOdometry odometry(testing::vision_calibration(), VisionConfig{});
  const PosePrior prior{{Eigen::Quaterniond::Identity(), Vector3d(1, 2, 3)}, prior_covariance()};
  CameraFrame short_of_pixels{0, 0, 640, 360, {}};
  CameraFrame wrong_size{0, 0, 320, 180, std::vector<std::uint8_t>(320 * 180, 100)};
  CameraFrame negative{0, 0, -1, -1, {}};
  for (const CameraFrame& frame : {CameraFrame{}, short_of_pixels, wrong_size, negative}) {
    const SolveResult result = odometry.process(frame, prior);
    EXPECT_EQ(result.spectrum.well_conditioned, 0);
    EXPECT_EQ(result.pose.translation, prior.mean.translation);
    EXPECT_FALSE(odometry.wants_keyframe());
    odometry.start_keyframe(Pose{}, Eigen::Quaterniond::Identity());
  }
  EXPECT_TRUE(odometry.features().empty());
}

TEST(VisualOdometry, IsDeterministic) {
  Drive first(weaving);
  Drive second(weaving);
  for (int i = 0; i < 20; ++i) {
    const SolveResult a = first.step({});
    const SolveResult b = second.step({});
    EXPECT_EQ(a.pose.translation, b.pose.translation);
    EXPECT_EQ(a.information, b.information);
  }
}

}  // namespace
}  // namespace plumbline
