// What a lidar's sweep and a camera's frame cost in the street: on one core, against real time, and in a long street
// against a short one. All costs are CPU time, so that what else the machine does leaves them alone.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "scenarios/catalogue.h"
#include "sensors/lidar.h"
#include "sim/ray_scene.h"
#include "sim/renderer.h"
#include "sim/scene_library.h"

namespace plumbline {
namespace {

constexpr double kShortest_m = 100.0;
constexpr double kLongest_m = 9300.0;
constexpr double kSpeed_mps = 10.0;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Street {
  explicit Street(double length_m)
      : world(World::from_scene(build_scene("street", {{"length_m", length_m}}, 1), 1)), rays(world) {}

  World world;
  RayScene rays;
};

/// A head 1.8 m above a route, looking along it.
Pose above_route(const Route& route, double along_m) {
  double left = along_m;
  std::size_t i = 1;
  for (; i + 1 < route.points.size(); ++i) {
    const double leg = (route.points[i] - route.points[i - 1]).norm();
    if (left <= leg) break;
    left -= leg;
  }
  const Eigen::Vector3d way = (route.points[i] - route.points[i - 1]).normalized();
  return {rotation_from_rpy({0.0, 0.0, std::atan2(way.y(), way.x())}),
          route.points[i - 1] + left * way + Eigen::Vector3d(0.0, 0.0, 1.8)};
}

/// Where streets of any length are the same; only what lies ahead differs.
std::vector<double> common_places() { return {10.0, 25.0, 40.0, 55.0, 70.0}; }

std::vector<double> places_along(double length_m, int count) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back((i + 0.5) / count * (length_m - 30.0));
  return places;
}

/// Some time of driving, from time 0.
PoseTrack drive(const Route& route, double from_m, double duration_s) {
  constexpr double kStep_s = 5e-3;
  PoseTrack track;
  for (std::int64_t i = 0; static_cast<double>(i) * kStep_s <= duration_s + 0.2; ++i) {
    track.push(i * 5'000'000, above_route(route, from_m + kSpeed_mps * kStep_s * static_cast<double>(i)));
  }
  return track;
}

double sweep_seconds(const Lidar& lidar, const Street& street, const PoseTrack& track, std::int64_t message) {
  const double start_s = cpu_seconds();
  benchmark::DoNotOptimize(lidar.scan({street.world, street.rays}, track, message * lidar.period_ns(), message));
  return cpu_seconds() - start_s;
}

LidarEffects without_sub_rays() {
  LidarEffects effects;
  effects.mixed_pixels = false;
  return effects;
}

/// An iteration is 3 s of driving somewhere along the tour. The sweep before them is not counted: nothing that
/// surrounds the place was near before.
void BM_SweepAlongTheStreet(benchmark::State& state, const LidarEffects& effects) {
  constexpr int kSweeps = 30;
  const Street street(kLongest_m);
  const Lidar lidar(catalogue_lidar("hdl64e"), Pose{}, 1, effects);
  const std::vector<double> places = places_along(kLongest_m, static_cast<int>(state.max_iterations));
  std::size_t stretches = 0;
  double cost_s = 0.0;
  double first_s = 0.0;
  for (auto _ : state) {
    const PoseTrack track = drive(street.world.routes().front(), places[stretches++], 0.1 * (kSweeps + 1));
    first_s += sweep_seconds(lidar, street, track, 0);
    for (int i = 1; i <= kSweeps; ++i) cost_s += sweep_seconds(lidar, street, track, i);
  }
  const double sweeps = kSweeps * static_cast<double>(stretches);
  state.counters["times_real_time"] = 1e-9 * static_cast<double>(lidar.period_ns()) * sweeps / cost_s;
  state.counters["first_at_a_place_ms"] = 1e3 * first_s / static_cast<double>(stretches);
}
BENCHMARK_CAPTURE(BM_SweepAlongTheStreet, hdl64e_ideal, LidarEffects::none())
    ->Unit(benchmark::kMillisecond)
    ->Iterations(10);
BENCHMARK_CAPTURE(BM_SweepAlongTheStreet, hdl64e_no_sub_rays, without_sub_rays())
    ->Unit(benchmark::kMillisecond)
    ->Iterations(10);

/// Sweeps at the same places of a short and a long street, in turn.
void BM_SweepInALongStreet(benchmark::State& state) {
  const Street short_street(kShortest_m);
  const Street long_street(static_cast<double>(state.range(0)));
  const Lidar lidar(catalogue_lidar("hdl64e"), Pose{}, 1, LidarEffects::none());
  std::vector<PoseTrack> tracks;
  for (const double place : common_places()) tracks.push_back(drive(long_street.world.routes().front(), place, 0.2));
  double short_s = 0.0;
  double long_s = 0.0;
  std::int64_t message = 0;
  for (auto _ : state) {
    const PoseTrack& track = tracks[static_cast<std::size_t>(message) % tracks.size()];
    short_s += sweep_seconds(lidar, short_street, track, message % 2);
    long_s += sweep_seconds(lidar, long_street, track, message % 2);
    ++message;
  }
  state.counters["ms"] = 1e3 * long_s / static_cast<double>(message);
  state.counters["to_100_m"] = long_s / short_s;
}
BENCHMARK(BM_SweepInALongStreet)
    ->ArgName("length_m")
    ->Arg(1000)
    ->Arg(9300)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(40);

RenderView view() {
  RenderView view;
  view.fx = view.fy = 400.0;
  view.cx = 319.5;
  view.cy = 179.5;
  return view;
}

double frame_seconds(Renderer& renderer, const Pose& world_from_body) {
  const Pose world_from_camera{world_from_body.rotation * body_from_optical_rotation(), world_from_body.translation};
  const RenderMoment moment{.world_from_camera = world_from_camera, .world_from_body = world_from_body};
  const double start_s = cpu_seconds();
  benchmark::DoNotOptimize(renderer.render(moment).luminance.data());
  return cpu_seconds() - start_s;
}

/// Tiles are there already, as they are for all frames of a drive but one in some hundred.
void BM_FrameAlongTheStreet(benchmark::State& state) {
  const Street street(kLongest_m);
  Renderer renderer(street.world, view(), {.threads = 0, .depth = false});
  const std::vector<double> places = places_along(kLongest_m, 40);
  double cost_s = 0.0;
  double first_s = 0.0;
  double worst_s = 0.0;
  std::size_t frames = 0;
  for (auto _ : state) {
    const Pose pose = above_route(street.world.routes().front(), places[frames++ % places.size()]);
    first_s += frame_seconds(renderer, pose);
    const double frame_s = frame_seconds(renderer, pose);
    worst_s = std::max(worst_s, frame_s);
    cost_s += frame_s;
  }
  state.counters["ms"] = 1e3 * cost_s / static_cast<double>(frames);
  state.counters["worst_ms"] = 1e3 * worst_s;
  state.counters["first_at_a_place_ms"] = 1e3 * first_s / static_cast<double>(frames);
}
BENCHMARK(BM_FrameAlongTheStreet)->Unit(benchmark::kMillisecond)->Iterations(80);

/// Frames at the same places of a short and a long street, in turn.
void BM_FrameInALongStreet(benchmark::State& state) {
  const Street short_street(kShortest_m);
  const Street long_street(static_cast<double>(state.range(0)));
  Renderer short_renderer(short_street.world, view(), {.threads = 0, .depth = false});
  Renderer long_renderer(long_street.world, view(), {.threads = 0, .depth = false});
  std::vector<Pose> poses;
  for (const double place : common_places()) {
    const Pose ahead = above_route(long_street.world.routes().front(), place);
    for (const double yaw : {0.0, 0.5 * M_PI, M_PI, 1.5 * M_PI}) {
      poses.push_back({ahead.rotation * rotation_from_rpy({0.0, 0.0, yaw}), ahead.translation});
    }
  }
  for (const Pose& pose : poses) {  // makes the tiles
    frame_seconds(short_renderer, pose);
    frame_seconds(long_renderer, pose);
  }
  double short_s = 0.0;
  double long_s = 0.0;
  std::size_t frames = 0;
  for (auto _ : state) {
    const Pose& pose = poses[frames++ % poses.size()];
    short_s += frame_seconds(short_renderer, pose);
    long_s += frame_seconds(long_renderer, pose);
  }
  state.counters["ms"] = 1e3 * long_s / static_cast<double>(frames);
  state.counters["to_100_m"] = long_s / short_s;
}
BENCHMARK(BM_FrameInALongStreet)
    ->ArgName("length_m")
    ->Arg(1000)
    ->Arg(9300)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(80);

}  // namespace
}  // namespace plumbline
