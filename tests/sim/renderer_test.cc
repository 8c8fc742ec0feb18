#include "sim/renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <sstream>
#include <stdexcept>

namespace plumbline {
namespace {

using Pattern = Material::Pattern;

constexpr double kPi = std::numbers::pi;

RenderView wide_view() {
  RenderView view;
  view.fx = view.fy = 474.0;
  view.cx = 319.5;
  view.cy = 179.5;
  return view;
}

Pose camera_at(const Eigen::Vector3d& position, double yaw = 0.0, double pitch = 0.0) {
  return {rotation_from_rpy({0.0, pitch, yaw}) * body_from_optical_rotation(), position};
}

struct Box {
  Eigen::Vector3d centre;
  Eigen::Vector3d half_size;
};

SceneDescription boxes(const std::vector<Box>& all, const Material& material) {
  std::ostringstream mjcf;
  mjcf << "<mujoco><asset><material name=\"" << material.name << "\"/></asset><worldbody>";
  for (const Box& box : all) {
    mjcf << "<geom type=\"box\" material=\"" << material.name << "\" pos=\"" << box.centre.transpose() << "\" size=\""
         << box.half_size.transpose() << "\"/>";
  }
  mjcf << "</worldbody></mujoco>";
  SceneDescription scene;
  scene.mjcf = mjcf.str();
  scene.materials = {material};
  scene.ambient_lux = 100.0;
  return scene;
}

const Material kGrey{.name = "grey", .pattern = Pattern::kPlain, .albedo = 0.5F, .contrast = 0.0F};

/// A wall whose face is at x = 0 and looks towards -x.
SceneDescription wall(const Material& material, double half_width = 40.0) {
  return boxes({{{0.5, 0.0, 0.0}, {0.5, half_width, 20.0}}}, material);
}

RenderMoment moment(const Pose& world_from_camera, double light_factor) {
  RenderMoment shown;
  shown.world_from_camera = world_from_camera;
  shown.light_factor = light_factor;
  return shown;
}

float pixel(const std::vector<float>& image, const RenderView& view, int u, int v) {
  return image[static_cast<std::size_t>(v * view.width + u)];
}

cv::Mat1b grey_image(const RadianceImage& image) {
  const cv::Mat1f radiance(image.height, image.width, const_cast<float*>(image.luminance.data()));
  cv::Mat1b grey;
  radiance.convertTo(grey, CV_8U, 100.0 / cv::mean(radiance)[0]);
  return grey;
}

SceneDescription crowded_room() {
  std::vector<Box> all = {{{0, 0, -1.5}, {20, 20, 0.1}}, {{12, 0, 0}, {0.1, 20, 3}}};
  for (int i = 0; i < 60; ++i) all.push_back({{2.0 + i % 8, 0.7 * i - 20.0, -1.0}, {0.2, 0.3, 0.1 + 0.02 * i}});
  SceneDescription scene = boxes(all, Material{.name = "brick", .pattern = Pattern::kBrick});
  for (int i = 0; i < 10; ++i)
    scene.lamps.push_back({.position = {2.0 + i, 3.0 * i - 15.0, 2.0}, .intensity_cd = 100.0});
  return scene;
}

/// Mesa reads the number of threads once per process, so each number gets a process of its own. This test stands first:
/// the processes must be split off before any other test has made a context here.
std::vector<float> frame_from_child_process(int threads) {
  const RenderView view = wide_view();
  std::vector<float> frame(static_cast<std::size_t>(view.width * view.height));
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    const World world = World::from_scene(crowded_room(), 1);
    Renderer renderer(world, view, {.threads = threads, .depth = false});
    const auto& luminance = renderer.render(moment(camera_at({0, 0, 0}, 0.1), 1.0)).luminance;
    std::size_t done = 0;
    const auto* bytes = reinterpret_cast<const char*>(luminance.data());
    while (done < luminance.size() * sizeof(float)) {
      const ssize_t written = write(ends[1], bytes + done, luminance.size() * sizeof(float) - done);
      if (written <= 0) _exit(1);
      done += static_cast<std::size_t>(written);
    }
    _exit(0);
  }
  close(ends[1]);
  std::size_t done = 0;
  auto* bytes = reinterpret_cast<char*>(frame.data());
  while (done < frame.size() * sizeof(float)) {
    const ssize_t got = read(ends[0], bytes + done, frame.size() * sizeof(float) - done);
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (done != frame.size() * sizeof(float) || status != 0) throw std::runtime_error("the child process failed");
  return frame;
}

TEST(Renderer, FramesAreTheSameForEveryNumberOfThreads) {
  const std::vector<float> alone = frame_from_child_process(0);
  EXPECT_GT(*std::max_element(alone.begin(), alone.end()), 0.0F);
  for (const int threads : {1, 2}) {
    EXPECT_EQ(std::memcmp(alone.data(), frame_from_child_process(threads).data(), alone.size() * sizeof(float)), 0);
  }
}

TEST(Renderer, EdgesAndDepthFollowThePinhole) {
  const Box box{{5.0, 0.3, -0.2}, {0.5, 0.6, 0.4}};
  const World world = World::from_scene(boxes({box}, kGrey), 1);
  const RenderView view = wide_view();
  Renderer renderer(world, view);
  const RadianceImage& image = renderer.render(moment(camera_at({0, 0, 0}), 1.0));
  // Of the front face, at 4.5 m; y is left, z is up.
  const double left = view.cx - view.fx * 0.9 / 4.5;
  const double right = view.cx + view.fx * 0.3 / 4.5;
  const double top = view.cy - view.fy * 0.2 / 4.5;
  const double bottom = view.cy + view.fy * 0.6 / 4.5;
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const bool inside = u > left + 0.01 && u < right - 0.01 && v > top + 0.01 && v < bottom - 0.01;
      const bool outside = u < left - 0.01 || u > right + 0.01 || v < top - 0.01 || v > bottom + 0.01;
      const float luminance = pixel(image.luminance, view, u, v);
      if (inside) {
        ASSERT_GT(luminance, 0.0F) << u << ' ' << v;
        ASSERT_NEAR(pixel(image.depth_m, view, u, v), 4.5, 4.5e-4);
      } else if (outside) {
        ASSERT_EQ(luminance, 0.0F) << u << ' ' << v;
        ASSERT_NEAR(pixel(image.depth_m, view, u, v), view.far_m, 1e-3);
      }
    }
  }
}

TEST(Renderer, DepthOfAFloorIsExactFarFromTheOriginToo) {
  const RenderView view = wide_view();
  for (const double x : {0.0, 9000.0}) {
    const World world = World::from_scene(boxes({{{x, 0.0, -0.5}, {100.0, 100.0, 0.5}}}, kGrey), 1);
    Renderer renderer(world, view);
    const RadianceImage& image = renderer.render(moment(camera_at({x, 3.0, 1.5}), 1.0));
    for (int v = 190; v < view.height; ++v) {
      const double depth = 1.5 * view.fy / (v - view.cy);
      for (int u = 0; u < view.width; u += 13) ASSERT_NEAR(pixel(image.depth_m, view, u, v), depth, 1e-3 * depth);
    }
  }
}

TEST(Renderer, AnInfinitePlaneReachesTheHorizon) {
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody><geom type=\"plane\" size=\"0 0 1\"/></worldbody></mujoco>";
  const World world = World::from_scene(scene, 1);
  const RenderView view = wide_view();
  Renderer renderer(world, view);
  const RadianceImage& image = renderer.render(moment(camera_at({0.0, 0.0, 1.5}), 1.0));
  for (int v = 184; v < view.height; ++v) {
    const double depth = 1.5 * view.fy / (v - view.cy);
    ASSERT_NEAR(pixel(image.depth_m, view, 320, v), depth, 1e-3 * depth);
  }
}

TEST(Renderer, LuminanceOfALitPlateFollowsLambertAndTheInverseSquare) {
  const RenderView view = wide_view();
  for (const double distance : {1.5, 3.0, 6.0}) {
    SceneDescription scene = wall(kGrey, 10.0);
    scene.ambient_lux = 20.0;
    scene.lamps = {{.position = {-distance, 1.0, 0.5}, .intensity_cd = 300.0, .reach_m = 60.0}};
    const World world = World::from_scene(scene, 1);
    Renderer renderer(world, view);
    const RadianceImage& image = renderer.render(moment(camera_at({-5, 0, 0}), 0.7));
    for (int v = 10; v < view.height; v += 20) {
      for (int u = 10; u < view.width; u += 20) {
        const Eigen::Vector3d point(0.0, -5.0 * (u - view.cx) / view.fx, -5.0 * (v - view.cy) / view.fy);
        const Eigen::Vector3d to_lamp = scene.lamps[0].position - point;
        const double range = to_lamp.norm();
        const double lux = 20.0 + 300.0 * distance / (range * range * range) * lamp_window(range, 60.0);
        ASSERT_NEAR(pixel(image.luminance, view, u, v) / (0.7 * 0.5 / kPi * lux), 1.0, 0.01) << distance;
      }
    }
  }
}

TEST(Renderer, TheSunLightsByTheCosineAndNothingFromBehind) {
  SceneDescription scene = wall(kGrey, 10.0);
  scene.ambient_lux = 1000.0;
  const RenderView view = wide_view();
  for (const double side : {-1.0, 1.0}) {
    scene.sun = {Eigen::Vector3d(0.6 * side, 0.0, 0.8), 50'000.0};
    const World world = World::from_scene(scene, 1);
    Renderer renderer(world, view);
    const double lux = 1000.0 + (side < 0.0 ? 0.6 * 50'000.0 : 0.0);
    const float luminance = pixel(renderer.render(moment(camera_at({-5, 0, 0}), 1.0)).luminance, view, 320, 180);
    EXPECT_NEAR(luminance / (0.5 / kPi * lux), 1.0, 1e-5);
  }
}

// Koschmieder's law: at the visibility, 2 % of a black wall's contrast with the air is left.
TEST(Renderer, FogLeavesTwoPercentOfTheContrastAtTheVisibility) {
  Material black = kGrey;
  black.albedo = 0.0F;
  World world = World::from_scene(wall(black), 1);
  world.atmosphere.fog_visibility_m = 30.0;
  const RenderView view = wide_view();
  Renderer renderer(world, view);
  const double air = pixel(renderer.render(moment(camera_at({-5, 0, 0}, kPi), 1.0)).luminance, view, 320, 180);
  const double seen = pixel(renderer.render(moment(camera_at({-30, 0, 0}), 1.0)).luminance, view, 320, 180);
  EXPECT_GT(air, 0.0);
  EXPECT_NEAR(1.0 - seen / air, 0.02, 1e-4);
}

TEST(Renderer, TwoSidedSurfacesAreSeenFromBehind) {
  SceneDescription scene = wall(kGrey, 1.0);
  SceneMesh leaf;
  leaf.name = "leaf";
  leaf.material = "grey";
  leaf.vertices = {{-2, -3, -3}, {-2, 3, -3}, {-2, 0, 3}};
  leaf.triangles = {{0, 1, 2}};  // faces +x, away from the camera
  scene.meshes = {leaf};
  const RenderView view = wide_view();
  for (const bool two_sided : {false, true}) {
    scene.materials.front().two_sided = two_sided;
    const World world = World::from_scene(scene, 1);
    Renderer renderer(world, view);
    const float depth = pixel(renderer.render(moment(camera_at({-5, 0, 0}), 1.0)).depth_m, view, 320, 180);
    EXPECT_NEAR(depth, two_sided ? 3.0 : 5.0, 1e-3);
  }
}

TEST(Renderer, LampsAddUpAndDarknessIsBlack) {
  SceneDescription scene = wall(kGrey, 10.0);
  scene.ambient_lux = 0.0;
  scene.sky_luminance = 50.0;
  for (int i = 0; i < 40; ++i) scene.lamps.push_back({.position = {-3, 0, 0}, .intensity_cd = 10.0, .reach_m = 100.0});
  const World world = World::from_scene(scene, 1);
  const RenderView view = wide_view();
  Renderer renderer(world, view);
  EXPECT_NEAR(pixel(renderer.render(moment(camera_at({-5, 0, 0}), 1.0)).luminance, view, 320, 180),
              0.5 / kPi * 400.0 / 9.0, 0.1);
  EXPECT_NEAR(pixel(renderer.render(moment(camera_at({-5, 0, 0}, kPi), 1.0)).luminance, view, 320, 180), 50.0, 1e-3);
  for (const double yaw : {0.0, kPi}) {
    EXPECT_THAT(renderer.render(moment(camera_at({-5, 0, 0}, yaw), 0.0)).luminance, ::testing::Each(0.0F));
  }
}

TEST(Renderer, EveryPatternHasCornersAtEveryDistance) {
  for (const Pattern pattern :
       {Pattern::kConcrete, Pattern::kBrick, Pattern::kPanels, Pattern::kSigns, Pattern::kAsphalt}) {
    const World world = World::from_scene(wall(Material{.name = "m", .pattern = pattern}), 1);
    Renderer renderer(world, wide_view(), {.threads = 0, .depth = false});
    for (const double distance : {1.0, 2.0, 5.0, 12.0, 20.0}) {
      const cv::Mat1b image = grey_image(renderer.render(moment(camera_at({-distance, 0, 0}), 1.0)));
      cv::Mat1f strength;
      cv::cornerMinEigenVal(image, strength, 3);
      // At least 1e-4 is some ten times what the camera's noise makes of an even wall.
      strength.setTo(0.0F, strength < 1e-4F);
      std::vector<cv::Point2f> corners;
      cv::goodFeaturesToTrack(image, corners, 1000, 1e-3, 12.0);
      const auto usable = std::count_if(corners.begin(), corners.end(), [&](const cv::Point2f& corner) {
        return strength(static_cast<int>(corner.y), static_cast<int>(corner.x)) > 0.0F;
      });
      EXPECT_GE(usable, 200) << "pattern " << static_cast<int>(pattern) << " at " << distance << " m";
    }
  }
}

TEST(Renderer, NoContrastMeansNoTexture) {
  const World world =
      World::from_scene(wall(Material{.name = "m", .pattern = Pattern::kBrick, .albedo = 0.4F, .contrast = 0.0F}), 1);
  Renderer renderer(world, wide_view());
  const auto& luminance = renderer.render(moment(camera_at({-3, 0, 0}), 1.0)).luminance;
  EXPECT_THAT(luminance, ::testing::Each(::testing::FloatNear(0.4F / std::numbers::pi_v<float> * 100.0F, 0.01F)));
}

TEST(Renderer, TwoPlacesOfAWallDoNotLookAlike) {
  for (const Pattern pattern :
       {Pattern::kConcrete, Pattern::kBrick, Pattern::kPanels, Pattern::kSigns, Pattern::kAsphalt}) {
    const World world = World::from_scene(wall(Material{.name = "m", .pattern = pattern}), 1);
    Renderer renderer(world, wide_view());
    const cv::Mat1b here = grey_image(renderer.render(moment(camera_at({-3, 0, 0}), 1.0))).clone();
    // 10 m away, and one and two periods of the structure away, where only the wear differs.
    for (const double shift : {10.0, 5.12, 10.24}) {
      const cv::Mat1b there = grey_image(renderer.render(moment(camera_at({-3, shift, 0}), 1.0)));
      cv::Mat1f match;
      cv::matchTemplate(here, there, match, cv::TM_CCOEFF_NORMED);
      EXPECT_LT(match(0, 0), 0.75F) << "pattern " << static_cast<int>(pattern) << " at " << shift << " m";
    }
  }
}

/// Median and 90th percentile of what KLT gets wrong between two views of the wall at x = 0 [px].
std::pair<double, double> tracking_error(Renderer& renderer, double distance, const Eigen::Vector3d& step) {
  const RenderView view = wide_view();
  const cv::Mat1b first = grey_image(renderer.render(moment(camera_at({-distance, 0, 0}), 1.0))).clone();
  const cv::Mat1b second =
      grey_image(renderer.render(moment(camera_at(Eigen::Vector3d(-distance, 0, 0) + step), 1.0))).clone();
  std::vector<cv::Point2f> corners;
  std::vector<cv::Point2f> tracked;
  std::vector<std::uint8_t> found;
  std::vector<float> residuals;
  cv::goodFeaturesToTrack(first, corners, 300, 0.01, 15.0);
  cv::calcOpticalFlowPyrLK(first, second, corners, tracked, found, residuals, {21, 21}, 3);
  std::vector<double> errors;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double y = -(corners[i].x - view.cx) / view.fx * distance;
    const double z = -(corners[i].y - view.cy) / view.fy * distance;
    const double depth = distance - step.x();
    const cv::Point2d truth(view.cx - view.fx * (y - step.y()) / depth, view.cy - view.fy * (z - step.z()) / depth);
    const bool inside = truth.x > 15 && truth.y > 15 && truth.x < view.width - 15 && truth.y < view.height - 15;
    if (inside && found[i] != 0) errors.push_back(std::hypot(tracked[i].x - truth.x, tracked[i].y - truth.y));
  }
  std::sort(errors.begin(), errors.end());
  return {errors.at(errors.size() / 2), errors.at(errors.size() * 9 / 10)};
}

TEST(Renderer, CornersCanBeTrackedWithoutShimmer) {
  for (const Pattern pattern :
       {Pattern::kConcrete, Pattern::kBrick, Pattern::kPanels, Pattern::kSigns, Pattern::kAsphalt}) {
    const World world = World::from_scene(wall(Material{.name = "m", .pattern = pattern}), 1);
    Renderer renderer(world, wide_view());
    for (const double distance : {2.0, 5.0, 12.0}) {
      for (const Eigen::Vector3d& step : {Eigen::Vector3d(0.0, 0.1, 0.03), Eigen::Vector3d(0.1, 0.0, 0.0)}) {
        const auto [median, high] = tracking_error(renderer, distance, step);
        const std::string label =
            "pattern " + std::to_string(static_cast<int>(pattern)) + " at " + std::to_string(distance);
        RecordProperty(label, std::to_string(median));
        EXPECT_LT(median, 0.15) << label;
        EXPECT_LT(high, 0.5) << label;
      }
    }
  }
}

TEST(Renderer, RejectsAViewWithoutAnImage) {
  const World world = World::from_scene(wall(kGrey), 1);
  RenderView view = wide_view();
  view.fx = 0.0;
  EXPECT_THAT([&] { Renderer(world, view); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("fx")));
}

}  // namespace
}  // namespace plumbline
