// What the lidar costs: rays per second against the number of triangles, and a whole scan of the VLP-16.
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "sensors/lidar.h"
#include "sim/geom_mesh.h"
#include "sim/random_stream.h"
#include "sim/ray_scene.h"
#include "sim/triangle_soup.h"

namespace plumbline {
namespace {

// A corridor 4 m wide and 3 m high with boxes of 12 triangles each along its walls.
World corridor(int boxes) {
  RandomStream stream(1, "corridor");
  std::ostringstream geoms;
  geoms
      << R"(<geom type="plane" size="0 0 1"/><geom type="box" size="200 0.1 1.5" pos="0 2.1 1.5"/>)"
      << R"(<geom type="box" size="200 0.1 1.5" pos="0 -2.1 1.5"/><geom type="box" size="200 2.2 0.1" pos="0 0 3.1"/>)";
  for (int i = 0; i < boxes; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    geoms << "<geom type=\"box\" size=\"" << stream.uniform(0.02, 0.2) << ' ' << stream.uniform(0.02, 0.4) << ' '
          << stream.uniform(0.02, 0.5) << "\" pos=\"" << stream.uniform(-100.0, 100.0) << ' ' << side * 1.9 << ' '
          << stream.uniform(0.0, 3.0) << "\"/>";
  }
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody>" + geoms.str() + "</worldbody></mujoco>";
  return World::from_scene(scene, 1);
}

std::vector<Eigen::Vector3d> directions(std::size_t count) {
  RandomStream stream(2, "rays");
  std::vector<Eigen::Vector3d> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = stream.uniform(0.0, 2.0 * std::numbers::pi);
    const double sine = stream.uniform(-0.26, 0.26);
    const double cosine = std::sqrt(1.0 - sine * sine);
    all.emplace_back(cosine * std::cos(azimuth), cosine * std::sin(azimuth), sine);
  }
  return all;
}

// The same triangles in a bare Embree scene of the same flags.
class BareScene {
 public:
  explicit BareScene(const World& world) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    TriangleSoup soup;
    for (int geom = 0; geom < world.geom_count(); ++geom) {
      const TriangleMesh mesh = mesh_of_geom(world.model(), geom, 0.01, 300.0);
      soup.append(mesh,
                  Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(world.data().geom_xmat + 9 * geom),
                  Eigen::Map<const Eigen::Vector3d>(world.data().geom_xpos + 3 * geom), geom);
    }
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<Eigen::Vector3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, soup.vertices().size()));
    auto* index = static_cast<TriangleSoup::Triangle*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, soup.triangles().size()));
    for (const Eigen::Vector3d& v : soup.vertices()) *vertex++ = v.cast<float>();
    std::copy(soup.triangles().begin(), soup.triangles().end(), index);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;
  ~BareScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  float range(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit found;
    found.ray = {origin.x(), origin.y(), origin.z(), 0.0F, direction.x(), direction.y(), direction.z(), 0.0F,
                 100.0F,     ~0U,        0U,         0U};
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &found);
    return found.ray.tfar;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

template <typename Work>
double seconds_of(Work work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Rays through a window, and the same rays through Embree alone, in turn.
void BM_CastOverBareEmbree(benchmark::State& state) {
  const World world = corridor(static_cast<int>(state.range(0)) / 12);
  const RayScene scene(world);
  const RayWindow window = scene.window({0, 0, 1.5}, 100.0);
  const BareScene bare(world);
  const std::vector<Eigen::Vector3d> rays = directions(100'000);
  std::vector<Eigen::Vector3f> rays_f;
  for (const Eigen::Vector3d& ray : rays) rays_f.push_back(ray.cast<float>());
  double ours_s = 0.0;
  double bare_s = 0.0;
  for (auto _ : state) {
    ours_s += seconds_of([&] {
      for (const Eigen::Vector3d& ray : rays) benchmark::DoNotOptimize(window.cast({0, 0, 1.5}, ray, 0.0, 100.0, 0.0));
    });
    bare_s += seconds_of([&] {
      for (const Eigen::Vector3f& ray : rays_f) benchmark::DoNotOptimize(bare.range({0, 0, 1.5F}, ray));
    });
  }
  const double cast = static_cast<double>(state.iterations() * static_cast<std::int64_t>(rays.size()));
  state.counters["rays_per_s"] = cast / ours_s;
  state.counters["bare_rays_per_s"] = cast / bare_s;
  state.counters["over_bare"] = bare_s / ours_s;
}
BENCHMARK(BM_CastOverBareEmbree)->ArgName("triangles")->Arg(1200)->Arg(24000)->Arg(120000)->Iterations(5);

void BM_Vlp16Scan(benchmark::State& state) {
  const World world = corridor(static_cast<int>(state.range(0)) / 12);
  const RayScene scene(world);
  const Lidar lidar(vlp16(), Pose{}, 1);
  PoseTrack track;
  for (int i = 0; i <= 20; ++i) {
    track.push(i * 5'000'000, Pose{Eigen::Quaterniond(1.0, 0.0, 0.0, 1e-3 * i).normalized(), {0.01 * i, 0.0, 1.5}});
  }
  std::int64_t index = 0;
  for (auto _ : state) benchmark::DoNotOptimize(lidar.scan({world, scene}, track, 0, index++));
  state.counters["seconds per simulated second"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * 0.1, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_Vlp16Scan)->ArgName("triangles")->Arg(1200)->Arg(24000)->Arg(120000)->Unit(benchmark::kMillisecond);

void BM_BuildScene(benchmark::State& state) {
  const World world = corridor(static_cast<int>(state.range(0)) / 12);
  for (auto _ : state) benchmark::DoNotOptimize(RayScene(world));
}
BENCHMARK(BM_BuildScene)->ArgName("triangles")->Arg(24000)->Arg(120000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumbline
