#include "scenarios/schema.h"
#include "sim/vehicles/vehicle.h"

namespace plumbline {
namespace {

constexpr Range kPlace_m{-10'000.0, 10'000.0};
constexpr Range kSpeed_mps{0.05, 60.0};
constexpr Range kSpeedFactor{0.1, 10.0};
constexpr Range kAcceleration_mps2{0.05, 50.0};
constexpr Range kRest_s{0.0, 600.0};
constexpr Range kSmoothing_s{0.1, 10.0};
constexpr Range kGaitFrequency_hz{0.0, 10.0};
constexpr Range kGaitAmplitude_m{0.0, 0.3};
constexpr Range kGaitTilt_deg{0.0, 30.0};
constexpr Range kImpact_mps2{0.0, 50.0};
constexpr Range kJump_m{0.0, 1.0};
constexpr Range kWander_deg{0.0, 20.0};
constexpr Range kSpin_dps{0.0, 1000.0};
constexpr Range kRouteStart_m{0.0, 100'000.0};
constexpr Range kRouteLength_m{1.0, 100'000.0};
constexpr Range kHeight_m{-10.0, 500.0};
constexpr Range kRoughness_m{0.0, 0.2};
constexpr Range kWind_mps{0.0, 20.0};
// The true motion is known so long after it was flown, at the least.
constexpr Range kLatency_ms{5.0, 2000.0};
constexpr Range kSwing_deg{0.0, 90.0};
constexpr Range kSwing_hz{0.01, 20.0};

Eigen::Vector3d point_of(const ConfigNode& node, const std::string& key) {
  if (!node.is_sequence() || node.items.size() != 3) fail_at(node, key, "a point [x, y, z] in metres");
  return {number_of(node.items[0], key, kPlace_m), number_of(node.items[1], key, kPlace_m),
          number_of(node.items[2], key, kPlace_m)};
}

/// Either a point, or a map of the point and the speed from there on.
MotionConfig::Waypoint waypoint_of(const ConfigNode& node, const std::string& key) {
  MotionConfig::Waypoint waypoint;
  if (!node.is_map()) {
    waypoint.position = point_of(node, key);
    return waypoint;
  }
  ConfigReader reader(node, key);
  const ConfigNode* point = reader.find("at_m");
  reader.read("speed_mps", waypoint.speed_mps, kSpeed_mps);
  reader.finish();
  if (point == nullptr) fail_at(node, key, "a point [x, y, z], or {at_m: [x, y, z], speed_mps: speed from there on}");
  waypoint.position = point_of(*point, reader.path_of("at_m"));
  return waypoint;
}

Oscillation oscillation_of(const ConfigNode& node, const std::string& key) {
  Oscillation oscillation;
  ConfigReader reader(node, key);
  std::size_t axis = 0;
  if (!reader.read_choice("axis", {"roll", "pitch", "yaw"}, axis)) fail_at(node, key, "an axis: roll, pitch or yaw");
  oscillation.axis = static_cast<Oscillation::Axis>(axis);
  reader.read("amplitude_deg", oscillation.amplitude_deg, kSwing_deg);
  reader.read("frequency_hz", oscillation.frequency_hz, kSwing_hz);
  reader.finish();
  return oscillation;
}

void read_gait(ConfigReader& reader, MotionConfig& config) {
  reader.read("frequency_hz", config.gait_frequency_hz, kGaitFrequency_hz);
  reader.read("height_m", config.gait_height_m, kGaitAmplitude_m);
  reader.read("sway_m", config.gait_sway_m, kGaitAmplitude_m);
  reader.read("roll_deg", config.gait_roll_deg, kGaitTilt_deg);
  reader.read("pitch_deg", config.gait_pitch_deg, kGaitTilt_deg);
  reader.read("impact_mps2", config.gait_impact_mps2, kImpact_mps2);
  reader.read("jump_m", config.gait_jump_m, kJump_m);
}

/// Starts from the vehicle's own way of moving. The words are the names of vehicle_library().
void read_vehicle(ConfigReader& reader, MotionConfig& config) {
  std::vector<std::string> names;
  for (const VehicleInfo& vehicle : vehicle_library()) names.push_back(vehicle.name);
  std::size_t index = 0;
  if (reader.read_choice("vehicle", names, index)) config = vehicle_library()[index].defaults;
}

MotionConfig::Stretch stretch_of(const ConfigNode& node, const std::string& key) {
  MotionConfig::Stretch stretch;
  ConfigReader reader(node, key);
  const bool from = reader.read("from_m", stretch.from_m, kRouteStart_m);
  const bool speed = reader.read("speed_mps", stretch.speed_mps, kSpeed_mps);
  reader.finish();
  if (!from || !speed) fail_at(node, key, "{from_m: along the route, speed_mps: speed from there on}");
  return stretch;
}

void read_closed_loop(ConfigReader& reader, MotionConfig::ClosedLoop& closed_loop) {
  reader.read("enabled", closed_loop.enabled);
  double latency_ms = 1e3 * closed_loop.latency_s;
  reader.read("latency_ms", latency_ms, kLatency_ms);
  closed_loop.latency_s = 1e-3 * latency_ms;
}

void read_route(ConfigReader& reader, MotionConfig& config) {
  reader.read("route", config.route);
  reader.read("route_start_m", config.route_start_m, kRouteStart_m);
  reader.read("route_length_m", config.route_length_m, kRouteLength_m);
  reader.read("height_m", config.height_m, kHeight_m);
}

void read_spin(ConfigReader& reader, MotionConfig& config) {
  reader.read("mean_deg_per_s", config.spin_mean_dps, kSpin_dps);
  reader.read("peak_deg_per_s", config.spin_peak_dps, kSpin_dps);
}

template <typename Item, typename Convert>
void read_list(ConfigReader& reader, const std::string& key, Convert convert, std::vector<Item>& items) {
  const ConfigNode* node = reader.find(key);
  if (node == nullptr) return;
  items.clear();
  const std::string path = reader.path_of(key);
  for (const auto& item : list_of(*node, path)) {
    items.push_back(convert(item, path + "[" + std::to_string(items.size()) + "]"));
  }
}

}  // namespace

void read_motion(ConfigReader& reader, MotionConfig& config) {
  read_vehicle(reader, config);
  read_route(reader, config);
  read_list(reader, "route_speeds", stretch_of, config.route_speeds);
  reader.read("tum", config.tum_file);
  read_list(reader, "waypoints", waypoint_of, config.waypoints);
  reader.read("speed_mps", config.speed_mps, kSpeed_mps);
  reader.read("speed_factor", config.speed_factor, kSpeedFactor);
  reader.read("acceleration_mps2", config.acceleration_mps2, kAcceleration_mps2);
  reader.read("lateral_acceleration_mps2", config.lateral_acceleration_mps2, kAcceleration_mps2);
  reader.read("rest_s", config.rest_s, kRest_s);
  reader.read("smoothing_s", config.smoothing_s, kSmoothing_s);
  std::size_t attitude = static_cast<std::size_t>(config.attitude);
  reader.read_choice("attitude", {"heading", "thrust"}, attitude);
  config.attitude = static_cast<MotionConfig::Attitude>(attitude);
  reader.section("gait", [&](ConfigReader& gait) { read_gait(gait, config); });
  reader.read("hand_wander_deg", config.hand_wander_deg, kWander_deg);
  reader.section("spin", [&](ConfigReader& spin) { read_spin(spin, config); });
  reader.read("roughness_m", config.roughness_m, kRoughness_m);
  reader.read("wind_mps", config.wind_mps, kWind_mps);
  read_list(reader, "oscillations", oscillation_of, config.oscillations);
  reader.section("closed_loop", [&](ConfigReader& loop) { read_closed_loop(loop, config.closed_loop); });
  reader.finish();  // a misspelt key is the better explanation of what is missing
  const bool has_waypoints = config.waypoints.size() >= 2;
  if (config.tum_file.empty() && config.route.empty() && !has_waypoints) {
    fail_at(reader.node(), reader.path_of("waypoints"),
            "at least two way-points, a route of the world under motion.route, or a trajectory under motion.tum");
  }
  if (!config.route.empty() && (has_waypoints || !config.tum_file.empty())) {
    fail_at(reader.node(), reader.path_of("route"), "either a route, way-points or a trajectory");
  }
  if (!config.route_speeds.empty() && config.route.empty()) {
    fail_at(reader.node(), reader.path_of("route_speeds"), "a route; way-points have their own speeds");
  }
  for (std::size_t i = 1; i < config.route_speeds.size(); ++i) {
    if (config.route_speeds[i].from_m > config.route_speeds[i - 1].from_m) continue;
    fail_at(reader.node(), reader.path_of("route_speeds"), "stretches in the order of their from_m");
  }
  if (config.closed_loop.enabled && config.vehicle != "quadrotor") {
    fail_at(reader.node(), reader.path_of("closed_loop.enabled"), "vehicle: quadrotor, which alone is controlled");
  }
  if (!config.tum_file.empty() && !config.vehicle.empty()) {
    fail_at(reader.node(), reader.path_of("vehicle"), "no vehicle for a trajectory that is played as it is");
  }
}

}  // namespace plumbline
