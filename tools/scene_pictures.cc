// A developer's program: a small picture of every scene of the library, as somebody sees it who follows its first
// route. `plumbline list scenes` names the files.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "sim/ray_scene.h"
#include "sim/renderer.h"
#include "sim/scene_library.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 480;
constexpr int kHeight = 270;
constexpr double kEyeHeight_m = 1.6;

struct Options {
  fs::path folder;
  std::vector<std::string> names;
  std::uint64_t seed = 1;
  double share = -1.0;  // of the route that lies behind; negative: where the most is seen
  std::size_t route = 0;
  double yaw_deg = 0.0;  // to the left of the route's direction
  double pitch_deg = 4.0;
};

/// A place on a route and the way it leads there.
struct Station {
  Eigen::Vector3d place;
  double yaw = 0.0;
};

Station station_on(const Route& route, double share) {
  std::vector<Eigen::Vector3d> points = route.points;
  if (route.closed) points.push_back(points.front());
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  double left = share * length;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Eigen::Vector3d leg = points[i] - points[i - 1];
    if (left <= leg.norm() || i + 1 == points.size()) {
      return {points[i - 1] + leg * std::min(1.0, left / leg.norm()), std::atan2(leg.y(), leg.x())};
    }
    left -= leg.norm();
  }
  throw std::invalid_argument("route " + route.name + " has fewer than two points");
}

Pose camera_at(const Station& station, const RayScene& rays, const Options& options) {
  constexpr double kFloorWithin_m = 0.4;  // otherwise the route is flown
  const Eigen::Vector3d above = station.place + 0.2 * Eigen::Vector3d::UnitZ();
  const bool on_floor = rays.cast(above, -Eigen::Vector3d::UnitZ(), 0.0, kFloorWithin_m).hit;
  constexpr double kDegree = M_PI / 180.0;
  const Eigen::Quaterniond world_from_body =
      rotation_from_rpy({0.0, options.pitch_deg * kDegree, station.yaw + options.yaw_deg * kDegree});
  return {world_from_body * body_from_optical_rotation(),
          station.place + (on_floor ? kEyeHeight_m : 0.0) * Eigen::Vector3d::UnitZ()};
}

float quantile(std::vector<float> values, double share) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// What an exponent makes of the picture's mean.
double mean_tone(const std::vector<float>& luminance, float white, double exponent) {
  double sum = 0.0;
  for (const float light : luminance) sum += std::pow(std::min(1.0F, light / white), exponent);
  return sum / static_cast<double>(luminance.size());
}

/// The exponent, near a display's 1 / 2.2, at which a picture is on average neither dark nor pale.
double tone_exponent(const std::vector<float>& luminance, float white) {
  constexpr double kMeanTone = 0.42;
  double low = 0.33;
  double high = 0.9;
  for (int i = 0; i < 12; ++i) {
    const double exponent = (low + high) / 2.0;
    (mean_tone(luminance, white, exponent) > kMeanTone ? low : high) = exponent;
  }
  return (low + high) / 2.0;
}

/// Exposed so that all but lamps and the brightest spots keep their detail.
cv::Mat3b developed(const RadianceImage& image) {
  const float white = std::max(quantile(image.luminance, 0.985), 1e-9F);
  const double exponent = tone_exponent(image.luminance, white);
  cv::Mat3b picture(image.height, image.width);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const auto pixel = static_cast<std::size_t>(v * image.width + u);
      for (std::size_t c = 0; c < 3; ++c) {
        const float light = std::clamp(image.rgb[3 * pixel + c] / white, 0.0F, 1.0F);
        picture(v, u)[static_cast<int>(2 - c)] = cv::saturate_cast<std::uint8_t>(255.0 * std::pow(light, exponent));
      }
    }
  }
  return picture;
}

RenderView view_of(int width, int height) {
  RenderView view{.width = width, .height = height};
  view.fx = view.fy = 0.62 * view.width;
  view.cx = view.width / 2.0 - 0.5;
  view.cy = view.height / 2.0 - 0.5;
  view.far_m = 400.0;
  return view;
}

/// How much there is to see: the parts of the picture with edges of things; those of wide views count more than those
/// of a wall close by. Over a plane the inverse of the depth is linear, so that it bends at edges alone.
double interest(const RadianceImage& image) {
  constexpr double kBend = 0.02;
  constexpr double kWide_m = 12.0;
  constexpr int kPart_px = 15;
  const cv::Mat1f depth = cv::Mat1f(image.depth_m, true).reshape(1, image.height);
  const cv::Mat1f inverse = 1.0F / depth;
  cv::Mat1f bend;
  cv::Laplacian(inverse, bend, CV_32F);
  const cv::Mat1b edges = cv::abs(bend.mul(depth)) > kBend;
  int parts = 0;
  for (int v = 0; v + kPart_px <= edges.rows; v += kPart_px) {
    for (int u = 0; u + kPart_px <= edges.cols; u += kPart_px) {
      if (cv::countNonZero(edges(cv::Rect(u, v, kPart_px, kPart_px))) >= kPart_px) ++parts;
    }
  }
  return parts * std::sqrt(std::min<double>(quantile(image.depth_m, 0.5), kWide_m));
}

RadianceImage photograph(Renderer& renderer, const Pose& world_from_camera) {
  return renderer.render({.world_from_camera = world_from_camera, .world_from_body = world_from_camera});
}

/// Where the most is seen of some places spread over the route, ahead or half to a side.
Options aimed(const World& world, const RayScene& rays, Options options) {
  constexpr int kPlaces = 8;
  Renderer renderer(world, view_of(kWidth, kHeight), {.threads = 1, .depth = true, .colour = false});
  Options best = options;
  double most = -1.0;
  for (int i = 0; i < kPlaces; ++i) {
    options.share = (i + 0.3) / kPlaces;
    const Station station = station_on(world.routes()[options.route], options.share);
    for (const double yaw_deg : {0.0, 40.0, -40.0}) {
      options.yaw_deg = yaw_deg;
      const double seen = interest(photograph(renderer, camera_at(station, rays, options)));
      if (seen <= most) continue;
      most = seen;
      best = options;
    }
  }
  return best;
}

void draw_scene(const SceneInfo& scene, const Options& asked) {
  World world = World::from_scene(build_scene(scene.name, {}, asked.seed), asked.seed);
  world.set_light_level(scene.usual_lux);
  const RayScene rays(world);
  if (world.routes().size() <= asked.route) {
    throw std::invalid_argument("scene " + scene.name + " has only " + std::to_string(world.routes().size()) +
                                " routes");
  }
  const Options options = asked.share < 0.0 ? aimed(world, rays, asked) : asked;
  const Station station = station_on(world.routes()[options.route], options.share);
  // Twice as large and then halved, for smooth edges.
  Renderer renderer(world, view_of(2 * kWidth, 2 * kHeight), {.threads = 1, .depth = false, .colour = true});
  cv::Mat3b picture;
  cv::resize(developed(photograph(renderer, camera_at(station, rays, options))), picture, {kWidth, kHeight}, 0, 0,
             cv::INTER_AREA);
  const fs::path file = options.folder / (scene.name + ".jpg");
  constexpr std::uintmax_t kMaxBytes = 40'000;
  for (int quality = 85; quality >= 40; quality -= 5) {
    if (!cv::imwrite(file.string(), picture, {cv::IMWRITE_JPEG_QUALITY, quality})) {
      throw std::runtime_error("cannot write " + file.string());
    }
    if (fs::file_size(file) <= kMaxBytes) break;
  }
  std::cout << file.string() << "\n";
}

int draw_scenes(const Options& options) {
  fs::create_directories(options.folder);
  for (const SceneInfo& scene : scene_library()) {
    const bool wanted = options.names.empty() ||
                        std::find(options.names.begin(), options.names.end(), scene.name) != options.names.end();
    if (wanted) draw_scene(scene, options);
  }
  return 0;
}

}  // namespace
}  // namespace plumbline

int main(int argc, char** argv) {
  plumbline::Options options;
  CLI::App app("Draws a picture of each scene");
  app.add_option("FOLDER", options.folder, "where to")->required();
  app.add_option("NAME", options.names, "scenes; all without any");
  app.add_option("--at", options.share,
                 "how much of the route lies behind, 0 to 1; without it, where the most is seen");
  app.add_option("--route", options.route, "number of the route, from 0");
  app.add_option("--seed", options.seed, "of the world");
  app.add_option("--yaw-deg", options.yaw_deg, "to the left of the route; needs --at");
  app.add_option("--pitch-deg", options.pitch_deg, "down");
  CLI11_PARSE(app, argc, argv);
  try {
    return plumbline::draw_scenes(options);
  } catch (const std::exception& error) {
    std::cerr << "scene_pictures: " << error.what() << "\n";
    return 2;
  }
}
