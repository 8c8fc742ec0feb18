#include "scenarios/schema.h"

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
  reader.read("tum", config.tum_file);
  read_list(reader, "waypoints", waypoint_of, config.waypoints);
  reader.read("speed_mps", config.speed_mps, kSpeed_mps);
  reader.read("speed_factor", config.speed_factor, kSpeedFactor);
  reader.read("acceleration_mps2", config.acceleration_mps2, kAcceleration_mps2);
  reader.read("rest_s", config.rest_s, kRest_s);
  reader.read("smoothing_s", config.smoothing_s, kSmoothing_s);
  std::size_t attitude = static_cast<std::size_t>(config.attitude);
  reader.read_choice("attitude", {"heading", "thrust"}, attitude);
  config.attitude = static_cast<MotionConfig::Attitude>(attitude);
  reader.section("gait", [&](ConfigReader& gait) { read_gait(gait, config); });
  read_list(reader, "oscillations", oscillation_of, config.oscillations);
  reader.finish();  // a misspelt key is the better explanation of what is missing
  if (config.tum_file.empty() && config.waypoints.size() < 2) {
    fail_at(reader.node(), reader.path_of("waypoints"), "at least two way-points, or a trajectory under motion.tum");
  }
}

}  // namespace plumbline
