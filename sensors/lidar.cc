#include "sensors/lidar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/random_stream.h"

namespace plumbline {
namespace {

using Source = FiringNoise::Source;

// Beyond this strength a loss is less likely than one in ten million.
constexpr double kCertain = 2.1;
constexpr std::size_t kTogether = LidarCaster::kMostTogether;

// std::round, which is no instruction of the processor's, of what is less than 2^52.
double rounded(double value) {
  const auto whole = static_cast<double>(static_cast<std::int64_t>(value));
  const double rest = value - whole;
  return rest >= 0.5 ? whole + 1.0 : rest <= -0.5 ? whole - 1.0 : whole;
}

std::int64_t nanoseconds(std::int64_t picoseconds) { return (picoseconds + 500) / 1000; }

void require_cover(const PoseTrack& track, std::int64_t start_ns, std::int64_t end_ns) {
  if (track.covers(start_ns) && track.covers(end_ns)) return;
  throw std::invalid_argument(
      "lidar: the motion must cover the revolution from " + std::to_string(start_ns) + " to " + std::to_string(end_ns) +
      " ns, but " +
      (track.empty() ? "is empty"
                     : "spans " + std::to_string(track.first_ns()) + " to " + std::to_string(track.last_ns()) + " ns"));
}

}  // namespace

Lidar::Lidar(LidarModel model, const Pose& body_from_lidar, std::uint64_t seed, const LidarEffects& effects,
             LidarReturns returns)
    : model_(std::move(model)),
      pattern_(model_),
      signal_(model_),
      footprint_(model_),
      body_from_lidar_(body_from_lidar),
      seed_(derive_seed(seed, "lidar")),
      effects_(effects),
      returns_(returns),
      echo_resolution_m_(0.5 * kSpeedOfLight_mps * model_.pulse_s) {
  RandomStream bias(seed_, "ring bias");
  for (std::size_t i = 0; i < pattern_.beams().size(); ++i) {
    const double range_bias_m = model_.ring_bias_sigma_m * bias.gaussian();
    range_bias_m_.push_back(effects_.ring_bias ? range_bias_m : 0.0);
  }
}

LidarScan Lidar::scan(const Surroundings& surroundings, const PoseTrack& world_from_body, std::int64_t start_ns,
                      std::int64_t scan_index) const {
  LidarScan scan;
  scan.stamp_ns = start_ns;
  scan.end_ns = start_ns + period_ns();
  const int parts = messages_per_sweep(model_);
  scan.sweep = scan_index / parts;
  scan.ends_sweep = scan_index % parts == parts - 1;
  require_cover(world_from_body, scan.stamp_ns, scan.end_ns);

  const std::vector<FiringPattern::Cycle> cycles = pattern_.cycles(scan_index, !effects_.quantisation);
  LidarCaster caster(surroundings, effects_.own_body ? surroundings.own_body : nullptr, world_from_body,
                     body_from_lidar_, pattern_, start_ns, model_.max_range_m);
  const LidarAir air(effects_.weather ? surroundings.world.atmosphere : Atmosphere{}, model_);

  const std::vector<FiringPattern::Beam>& beams = pattern_.beams();
  const std::uint64_t key = mix_bits(seed_ ^ mix_bits(static_cast<std::uint64_t>(scan_index)));
  scan.points.reserve(cycles.size() * beams.size());
  LidarEchoes echoes;
  // Cycles are cast some together, ahead of the one that reports; the one before it is kept.
  std::array<CastCycle, 3 * kTogether> cast;
  std::size_t cast_until = 0;
  for (std::size_t k = 0; k < cycles.size(); ++k) {
    while (cast_until < std::min(k + 2, cycles.size())) {
      const std::size_t count = std::min(kTogether, cycles.size() - cast_until);
      cast_centres({&cycles[cast_until], count}, caster, {&cast[cast_until % cast.size()], count});
      cast_until += count;
    }
    const CastCycle& at = cast[k % cast.size()];
    const CastCycle* before = k > 0 ? &cast[(k - 1) % cast.size()] : nullptr;
    const CastCycle* after = k + 1 < cycles.size() ? &cast[(k + 1) % cast.size()] : nullptr;
    for (std::size_t beam = 0; beam < beams.size(); ++beam) {
      if (!fires(cycles[k], beams[beam])) continue;
      const Firing firing{before,
                          at,
                          after,
                          beam,
                          cycles[k].offset_ps + beams[beam].offset_ps,
                          FiringNoise(mix_bits(key + k * beams.size() + beam))};
      echoes.clear();
      find_echoes(firing, air, caster, echoes);
      report(echoes, firing, scan.points);
    }
  }
  return scan;
}

bool Lidar::fires(const FiringPattern::Cycle& cycle, const FiringPattern::Beam& beam) const {
  const std::int64_t time_ps = cycle.offset_ps + beam.offset_ps;
  return time_ps >= 0 && time_ps < pattern_.message_ps();
}

// A beam looks about the same way from one cycle to the next: that makes the packets.
void Lidar::cast_centres(std::span<const FiringPattern::Cycle> cycles, LidarCaster& caster,
                         std::span<CastCycle> cast) const {
  const std::vector<FiringPattern::Beam>& beams = pattern_.beams();
  for (std::size_t k = 0; k < cycles.size(); ++k) {
    cast[k].cycle = &cycles[k];
    cast[k].motion = caster.motion_of(cycles[k]);
    cast[k].hits.assign(beams.size(), {});
  }
  std::array<LidarCaster::Shot, kTogether> shots;
  std::array<std::size_t, kTogether> cycle_of_shot;
  std::array<LidarHit, kTogether> hits;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < cycles.size(); ++k) {
      if (!fires(cycles[k], beams[i])) continue;
      cycle_of_shot[count] = k;
      shots[count++] = {&cast[k].motion,
                        {beams[i].origin_in_head, beams[i].direction_in_head},
                        cycles[k].offset_ps + beams[i].offset_ps};
    }
    caster.cast({shots.data(), count}, hits);
    for (std::size_t shot = 0; shot < count; ++shot) cast[cycle_of_shot[shot]].hits[i] = hits[shot];
  }
}

void Lidar::find_echoes(const Firing& firing, const LidarAir& air, const LidarCaster& caster,
                        LidarEchoes& echoes) const {
  const LidarHit& centre = firing.at.hits[firing.beam];
  if (effects_.mixed_pixels && meets_an_edge(firing, caster)) {
    add_sub_rays(firing, air, caster, echoes);
  } else if (!centre.is_none()) {
    echoes.add(echo_of(centre, air));
  }
  if (air.is_clear()) return;
  double until_m = model_.max_range_m;
  for (const LidarEcho& echo : echoes) until_m = std::min(until_m, echo.range_m);
  air.add_echoes(signal_, firing.noise, until_m, echoes);
}

// The centre rays around this one show where an edge may be near enough to matter; two rays at the beam's rim in that
// direction tell. What is thinner than the beams' spacing and missed by all of them stays unseen.
bool Lidar::meets_an_edge(const Firing& firing, const LidarCaster& caster) const {
  const FiringPattern::Beam& beam = pattern_.beams()[firing.beam];
  const LidarHit& centre = firing.at.hits[firing.beam];
  const auto goes_on = [&](const CastCycle* neighbour) {
    return neighbour == nullptr || centre.continues_in(neighbour->hits[firing.beam]);
  };
  const auto goes_on_in = [&](int neighbour) {
    return neighbour < 0 || centre.continues_in(firing.at.hits[static_cast<std::size_t>(neighbour)]);
  };
  const auto differs_at = [&](double side, double up) {
    const HeadRay rim = footprint_.ray(beam, {side, up});
    return !centre.continues_in(caster.cast(firing.at.motion, rim, firing.time_ps));
  };
  const bool side_is_plane = goes_on(firing.before) && goes_on(firing.after);
  if (!side_is_plane && (differs_at(1.0, 0.0) || differs_at(-1.0, 0.0))) return true;
  const bool is_alone = beam.above < 0 && beam.below < 0;
  const bool column_is_plane = !is_alone && goes_on_in(beam.above) && goes_on_in(beam.below);
  return !column_is_plane && (differs_at(0.0, 1.0) || differs_at(0.0, -1.0));
}

void Lidar::add_sub_rays(const Firing& firing, const LidarAir& air, const LidarCaster& caster,
                         LidarEchoes& echoes) const {
  const FiringPattern::Beam& beam = pattern_.beams()[firing.beam];
  const LidarFootprint::Places places = footprint_.places(firing.noise.uniform(Source::kFootprint));
  std::array<LidarCaster::Shot, kTogether> shots;
  std::array<LidarHit, kTogether> hits;
  for (std::size_t first = 0; first < places.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, places.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      shots[i] = {&firing.at.motion, footprint_.ray(beam, places[first + i]), firing.time_ps};
    }
    caster.cast({shots.data(), count}, hits);
    for (LidarHit& hit : std::span(hits).first(count)) {
      if (hit.is_none()) continue;
      hit.reflectivity /= LidarFootprint::kRays;
      LidarEcho echo = echo_of(hit, air);
      echo.spread_m = 0.0;  // the sub-rays' own spread stands for it
      echoes.add(echo);
    }
  }
  echoes.merge(echo_resolution_m_);
}

LidarEcho Lidar::echo_of(const LidarHit& hit, const LidarAir& air) const {
  const double range_m = hit.range_m;
  const double transmission = air.is_clear() ? 1.0 : air.transmission(range_m);
  return {range_m, signal_.strength(range_m, double{hit.reflectivity} * double{hit.cos_incidence}, transmission),
          effects_.range_noise ? signal_.spread_m(range_m, hit.cos_incidence) : 0.0};
}

bool Lidar::is_detected(const LidarEcho& echo, unsigned index, const FiringNoise& noise) const {
  if (!effects_.drop_out || echo.strength >= kCertain) return true;
  return noise.uniform(Source::kDetection, index) < signal_.detection_probability(echo.strength);
}

void Lidar::report(const LidarEchoes& echoes, const Firing& firing, std::vector<LidarPoint>& points) const {
  const LidarEcho* strongest = nullptr;
  const LidarEcho* second = nullptr;
  const LidarEcho* last = nullptr;
  unsigned index = 0;
  for (const LidarEcho& echo : echoes) {
    if (!is_detected(echo, index++, firing.noise)) continue;
    if (!strongest || echo.strength > strongest->strength) {
      second = std::exchange(strongest, &echo);
    } else if (!second || echo.strength > second->strength) {
      second = &echo;
    }
    if (!last || echo.range_m > last->range_m) last = &echo;
  }
  if (!strongest) return;
  add_point(returns_ == LidarReturns::kLast ? *last : *strongest, Source::kRange, firing, points);
  if (returns_ != LidarReturns::kDual) return;
  const LidarEcho* other = last == strongest ? second : last;
  if (other) add_point(*other, Source::kSecondRange, firing, points);
}

void Lidar::add_point(const LidarEcho& echo, Source source, const Firing& firing,
                      std::vector<LidarPoint>& points) const {
  double range_m = echo.range_m + range_bias_m_[firing.beam];
  if (effects_.range_noise)
    range_m += firing.noise.gaussian(source) * signal_.range_sigma_m(echo.strength, echo.spread_m);
  const double resolution_m = model_.range_resolution_m;
  if (effects_.quantisation && resolution_m > 0.0) range_m = resolution_m * rounded(range_m / resolution_m);
  if (range_m < model_.min_range_m || range_m > model_.max_range_m) return;

  const FiringPattern::Beam& beam = pattern_.beams()[firing.beam];
  const Eigen::Vector3d in_head = beam.origin_in_head + range_m * beam.direction_in_head;
  LidarPoint point;
  const FiringPattern::Cycle& cycle = *firing.at.cycle;
  point.position = (cycle.reported_lidar_from_head * in_head).cast<float>();
  point.offset_ns = static_cast<std::int32_t>(nanoseconds(firing.time_ps));
  point.ring = static_cast<std::uint16_t>(beam.ring + cycle.first_ring);
  point.intensity = static_cast<float>(std::clamp(signal_.intensity(echo.range_m, echo.strength), 0.0, 1.0));
  points.push_back(point);
}

}  // namespace plumbline
