#include "sim/glare.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

constexpr double kEyeHeight_m = 1.5;
constexpr double kFarthest_m = 20.0;
constexpr double kInFront_m = 0.5;
constexpr double kReach_m = 3.0;
constexpr double kPatch_lux = 200'000.0;  // twice the sun's
constexpr int kTries = 16;                // for a patch, where the route has open sides

}  // namespace

std::vector<Lamp> glare_lamps(const World& world, const RayScene& rays, int patches) {
  if (world.routes().empty() || world.routes().front().points.empty()) {
    throw std::invalid_argument("glare patches lie along the scene's first route, and this scene has none");
  }
  const std::vector<Eigen::Vector3d>& route = world.routes().front().points;
  RandomStream stream(world.seed(), "glare");
  std::vector<Lamp> lamps;
  for (int tries = 0; tries < kTries * patches && static_cast<int>(lamps.size()) < patches; ++tries) {
    const Eigen::Vector3d eye = route[static_cast<std::size_t>(stream.integer(0, static_cast<int>(route.size()) - 1))] +
                                kEyeHeight_m * Eigen::Vector3d::UnitZ();
    const double azimuth = stream.uniform(0.0, 2.0 * std::numbers::pi);
    const Eigen::Vector3d ahead(std::cos(azimuth), std::sin(azimuth), 0.0);
    const RayHit hit = rays.cast(eye, ahead, kInFront_m, kFarthest_m);
    if (!hit.hit) continue;
    const Eigen::Vector3d place = eye + hit.range_m * ahead + kInFront_m * hit.normal_in_world.cast<double>();
    lamps.push_back({place, kPatch_lux * kInFront_m * kInFront_m, kReach_m});
  }
  return lamps;
}

}  // namespace plumbline
