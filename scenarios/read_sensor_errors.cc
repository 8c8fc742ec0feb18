#include "scenarios/read_sensor_errors.h"

#include "scenarios/catalogue_file.h"

namespace plumbline {
namespace {

constexpr Range kShare{0.0, 1.0};
constexpr double kDefaultPartialShare = 0.5;

Eigen::Vector3d drawn(double sigma, RandomStream& stream) {
  Eigen::Vector3d draw;
  for (double& value : draw) value = sigma * stream.gaussian();
  return draw;
}

Fault fault_of(const ConfigNode& node, const std::string& key) {
  Fault fault;
  ConfigReader reader(node, key);
  std::size_t sensor = 0;
  std::size_t kind = 0;
  const bool has_sensor = reader.read_choice("sensor", faulty_sensor_names(), sensor);
  const bool has_kind = reader.read_choice("kind", fault_kind_names(), kind);
  fault.sensor = static_cast<FaultySensor>(sensor);
  fault.kind = static_cast<FaultKind>(kind);
  if (fault.kind == FaultKind::kPartial) fault.share = kDefaultPartialShare;
  const bool has_start = reader.read("start_s", fault.start_s, kRunTime_s);
  const bool has_end = reader.read("end_s", fault.end_s, kRunTime_s);
  reader.read("probability", fault.probability, kShare);
  reader.read("share", fault.share, kShare);
  reader.finish();
  if (!has_sensor || !has_kind || !has_start || !has_end) {
    fail_at(node, key, "sensor, kind, start_s and end_s in every entry");
  }
  if (fault.end_s <= fault.start_s) fail_at(node, key, "an end_s after start_s");
  if (!can_befall(fault.sensor, fault.kind)) {
    fail_at(node, key + ".kind", "a kind that this sensor can have: " + fault_kind_names()[kind] + " is none of them");
  }
  return fault;
}

}  // namespace

void read_timing(ConfigReader& reader, SensorTiming& timing) {
  reader.section("clock", [&](ConfigReader& clock) {
    read_scaled(clock, "offset_ms", kMilli, timing.clock.offset_s, {-10'000.0, 10'000.0});
    read_scaled(clock, "drift_ppm", kMicro, timing.clock.drift, {-10'000.0, 10'000.0});
    read_scaled(clock, "jitter_us", kMicro, timing.clock.jitter_s, {0.0, 1e6});
  });
  read_scaled(reader, "delay_ms", kMilli, timing.transport.delay_s, {0.0, 10'000.0});
  read_scaled(reader, "delay_jitter_ms", kMilli, timing.transport.jitter_s, {0.0, 10'000.0});
}

Pose read_miscalibration(ConfigReader& reader, std::uint64_t seed, const std::string& sensor) {
  Pose error;
  reader.section("miscalibration", [&](ConfigReader& keys) {
    Eigen::Vector3d rpy_deg = Eigen::Vector3d::Zero();
    double sigma_deg = 0.0;
    double sigma_m = 0.0;
    keys.read("roll_deg", rpy_deg.x(), {-180.0, 180.0});
    keys.read("pitch_deg", rpy_deg.y(), {-180.0, 180.0});
    keys.read("yaw_deg", rpy_deg.z(), {-180.0, 180.0});
    keys.read("x_m", error.translation.x(), {-10.0, 10.0});
    keys.read("y_m", error.translation.y(), {-10.0, 10.0});
    keys.read("z_m", error.translation.z(), {-10.0, 10.0});
    keys.read("sigma_deg", sigma_deg, {0.0, 30.0});
    keys.read("sigma_m", sigma_m, {0.0, 1.0});
    RandomStream stream(seed, sensor + ".miscalibration");
    rpy_deg += drawn(sigma_deg, stream);
    error.translation += drawn(sigma_m, stream);
    error.rotation = rotation_from_rpy(rpy_deg * kDegree);
  });
  return error;
}

void read_faults(const ConfigNode& node, const std::string& key, std::vector<Fault>& faults) {
  faults.clear();
  for (const ConfigNode& item : list_of(node, key)) {
    faults.push_back(fault_of(item, key + "[" + std::to_string(faults.size()) + "]"));
  }
}

}  // namespace plumbline
