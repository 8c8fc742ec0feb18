#include "scenarios/read_lidar.h"

#include "scenarios/rig_reader.h"

namespace plumbline {
namespace {

constexpr Range kLidarRate_hz{1.0, 50.0};

/// In the order of LidarReturns.
const std::vector<std::string> kReturns = {"strongest", "last", "dual"};

void read_effects(ConfigReader& reader, LidarEffects& effects) {
  reader.read("range_noise", effects.range_noise);
  reader.read("ring_bias", effects.ring_bias);
  reader.read("drop_out", effects.drop_out);
  reader.read("mixed_pixels", effects.mixed_pixels);
  reader.read("weather", effects.weather);
  reader.read("own_body", effects.own_body);
  reader.read("quantisation", effects.quantisation);
}

}  // namespace

void read_lidar_device(ConfigReader& reader, RigConfig& config) {
  reader.read("enabled", config.has_lidar);
  read_model(reader, "lidar", catalogue_lidar, config.lidar);
  reader.read("rate_hz", config.lidar.rate_hz, kLidarRate_hz);
  std::size_t returns = 0;
  if (reader.read_choice("returns", kReturns, returns)) config.lidar_returns = static_cast<LidarReturns>(returns);
  bool noise = true;
  if (reader.read("noise", noise) && !noise) config.lidar_effects = LidarEffects::none();
  reader.section("effects", [&](ConfigReader& effects) { read_effects(effects, config.lidar_effects); });
  check_model(reader, config.lidar);
}

}  // namespace plumbline
