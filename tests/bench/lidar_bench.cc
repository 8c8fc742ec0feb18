// What a lidar's scan costs on one core in a street of 100,000 triangles: against real time, and against a bare loop of
// rtcIntersect1 over the same rays and triangles.
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <ctime>
#include <sstream>
#include <string>
#include <vector>

#include "scenarios/catalogue.h"
#include "sensors/lidar.h"
#include "sim/random_stream.h"

namespace plumbline {
namespace {

struct Block {
  Eigen::Vector3d centre;
  Eigen::Vector3d half_size;
};

// A road of 200 m between façades with relief, cars and posts, and leaves in the trees' crowns; 12 triangles a block.
std::vector<Block> street() {
  RandomStream stream(1, "street");
  std::vector<Block> blocks = {{{0, 0, -0.5}, {150, 60, 0.5}}};
  const auto scatter = [&](int count, double y_low, double y_high, double z_low, double z_high, double least,
                           double greatest) {
    for (int i = 0; i < count; ++i) {
      const double side = stream.uniform() < 0.5 ? -1.0 : 1.0;
      const Eigen::Vector3d centre(stream.uniform(-100.0, 100.0), side * stream.uniform(y_low, y_high),
                                   stream.uniform(z_low, z_high));
      blocks.push_back(
          {centre,
           {stream.uniform(least, greatest), stream.uniform(least, greatest), stream.uniform(least, greatest)}});
    }
  };
  scatter(60, 14.0, 16.0, 3.0, 6.0, 3.0, 6.0);    // houses
  scatter(3000, 9.0, 11.0, 0.5, 9.0, 0.05, 0.6);  // relief
  scatter(60, 4.0, 6.0, 0.3, 0.9, 0.5, 0.9);      // cars
  scatter(5200, 6.5, 8.5, 3.0, 5.0, 0.02, 0.06);  // leaves
  return blocks;
}

World world_of(const std::vector<Block>& blocks) {
  std::ostringstream geoms;
  for (const Block& block : blocks) {
    geoms << "<geom type=\"box\" pos=\"" << block.centre.transpose() << "\" size=\"" << block.half_size.transpose()
          << "\"/>";
  }
  SceneDescription scene;
  scene.mjcf = "<mujoco><worldbody>" + geoms.str() + "</worldbody></mujoco>";
  return World::from_scene(scene, 1);
}

// 10 m/s along the road, swaying.
PoseTrack drive() {
  PoseTrack track;
  for (int i = 0; i <= 600; ++i) {
    const double time_s = 2e-3 * i;
    const Eigen::Quaterniond rotation(Eigen::AngleAxisd(0.05 * std::sin(6.0 * time_s), Eigen::Vector3d::UnitZ()));
    track.push(i * 2'000'000, {rotation, {10.0 * time_s - 5.0, 0.0, 1.8}});
  }
  return track;
}

/// Embree alone.
class BareScene {
 public:
  explicit BareScene(const std::vector<Block>& blocks) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<Eigen::Vector3f*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Eigen::Vector3f), 8 * blocks.size()));
    auto* index = static_cast<std::array<unsigned, 3>*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(std::array<unsigned, 3>), 12 * blocks.size()));
    constexpr unsigned kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    unsigned first = 0;
    for (const Block& block : blocks) {
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d sign(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        *vertex++ = (block.centre + sign.cwiseProduct(block.half_size)).cast<float>();
      }
      for (const auto& face : kFaces) {
        *index++ = {first + face[0], first + face[1], first + face[2]};
        *index++ = {first + face[0], first + face[2], first + face[3]};
      }
      first += 8;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    rtcCommitScene(scene_);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;
  ~BareScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  void cast(std::vector<RTCRayHit>& rays) const {
    for (RTCRayHit& ray : rays) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcIntersect1(scene_, &context, &ray);
    }
    benchmark::DoNotOptimize(rays.data());
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

std::vector<RTCRayHit> rays_of(const Lidar& lidar, const PoseTrack& world_from_body, std::int64_t message) {
  std::vector<RTCRayHit> rays;
  const std::int64_t start_ns = message * lidar.period_ns();
  for (const FiringPattern::Cycle& cycle : lidar.pattern().cycles(message, true)) {
    for (const FiringPattern::Beam& beam : lidar.pattern().beams()) {
      const std::int64_t time_ps = cycle.offset_ps + beam.offset_ps;
      if (time_ps < 0 || time_ps >= lidar.pattern().message_ps()) continue;
      const Pose pose = world_from_body.at(start_ns + time_ps / 1000);
      const Eigen::Vector3f origin = (pose * (cycle.lidar_from_head * beam.origin_in_head)).cast<float>();
      const Eigen::Vector3f way = (pose.rotation * (cycle.lidar_from_head * beam.direction_in_head)).cast<float>();
      RTCRayHit ray{};
      ray.ray = {origin.x(), origin.y(), origin.z(), 0.0F, way.x(), way.y(), way.z(), 0.0F, 120.0F, ~0U, 0U, 0U};
      ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rays.push_back(ray);
    }
  }
  return rays;
}

/// Of this process, so that what else the machine does leaves the ratios alone; all here runs on one thread.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// An iteration is one revolution by the lidar and its rays by Embree alone.
void BM_LidarScan(benchmark::State& state, const std::string& model, const LidarEffects& effects) {
  const std::vector<Block> blocks = street();
  const World world = world_of(blocks);
  const RayScene rays(world);
  const BareScene bare(blocks);
  const PoseTrack track = drive();
  const Lidar lidar(catalogue_lidar(model), Pose{}, 1, effects);
  double scan_s = 0.0;
  double bare_s = 0.0;
  double simulated_s = 0.0;
  std::int64_t message = 0;
  for (auto _ : state) {
    std::vector<RTCRayHit> same_rays = rays_of(lidar, track, message);
    const double start_s = cpu_seconds();
    benchmark::DoNotOptimize(lidar.scan({world, rays}, track, message * lidar.period_ns(), message));
    scan_s += cpu_seconds() - start_s;
    const double bare_start_s = cpu_seconds();
    bare.cast(same_rays);
    bare_s += cpu_seconds() - bare_start_s;
    simulated_s += 1e-9 * static_cast<double>(lidar.period_ns());
    message = (message + 1) % 10;
  }
  state.counters["times_real_time"] = simulated_s / scan_s;
  state.counters["of_bare_embree"] = bare_s / scan_s;
}

LidarEffects without_sub_rays() {
  LidarEffects effects;
  effects.mixed_pixels = false;
  return effects;
}

BENCHMARK_CAPTURE(BM_LidarScan, vlp16_ideal, "vlp16", LidarEffects::none())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_LidarScan, vlp16, "vlp16", LidarEffects{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_LidarScan, hdl64e_ideal, "hdl64e", LidarEffects::none())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_LidarScan, hdl64e_no_sub_rays, "hdl64e", without_sub_rays())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_LidarScan, hdl64e, "hdl64e", LidarEffects{})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace plumbline
