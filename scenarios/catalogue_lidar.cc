#include "scenarios/catalogue.h"
#include "scenarios/catalogue_file.h"

namespace plumbline {
namespace {

constexpr double kNano = 1e-9;

/// A figure of all beams, in firing order; a file may leave it out where it is 0 for all.
void read_per_beam(ConfigReader& reader, const std::string& key, double unit, Range range, double LidarBeam::*figure,
                   LidarModel& model) {
  std::vector<double> values;
  if (!reader.read(key, values, range)) return;
  if (model.beams.empty()) model.beams.resize(values.size());
  if (values.size() != model.beams.size()) {
    fail_at(*reader.find(key), reader.path_of(key), std::to_string(model.beams.size()) + " numbers, one per beam");
  }
  for (std::size_t i = 0; i < values.size(); ++i) model.beams[i].*figure = unit * values[i];
}

void read_beams(ConfigReader& reader, LidarModel& model) {
  read_per_beam(reader, "elevation_deg", 1.0, {-90.0, 90.0}, &LidarBeam::elevation_deg, model);
  read_per_beam(reader, "azimuth_deg", 1.0, {-180.0, 180.0}, &LidarBeam::azimuth_deg, model);
  read_per_beam(reader, "vertical_offset_mm", kMilli, {-1000.0, 1000.0}, &LidarBeam::vertical_offset_m, model);
  read_per_beam(reader, "firing_us", kMicro, {0.0, 1000.0}, &LidarBeam::firing_s, model);
}

LidarHead read_spinning_head(ConfigReader& reader) {
  SpinningHead head;
  read_scaled(reader, "cycle_us", kMicro, head.cycle_s, {1.0, 1000.0});
  return head;
}

LidarHead read_column_head(ConfigReader& reader) {
  ColumnHead head;
  reader.read("columns", head.columns, {16.0, 65536.0});
  read_scaled(reader, "beam_origin_mm", kMilli, head.beam_origin_m, {0.0, 1000.0});
  return head;
}

LidarHead read_two_axis_head(ConfigReader& reader) {
  TwoAxisHead head;
  reader.read("line_rate_hz", head.line_rate_hz, {1.0, 10000.0});
  reader.read("steps_per_turn", head.steps_per_turn, {16.0, 65536.0});
  reader.read("first_step", head.first_step, {0.0, 65536.0});
  reader.read("last_step", head.last_step, {0.0, 65536.0});
  reader.read("front_step", head.front_step, {0.0, 65536.0});
  reader.read("continuous", head.continuous);
  reader.read("joint_deg_per_s", head.joint_deg_per_s, {1.0, 3600.0});
  return head;
}

LidarHead read_head(ConfigReader& reader) {
  std::size_t kind = 0;
  reader.read_choice("head", {"spinning", "columns", "two_axis"}, kind);
  if (kind == 0) return read_spinning_head(reader);
  return kind == 1 ? read_column_head(reader) : read_two_axis_head(reader);
}

void read_ranges(ConfigReader& reader, LidarModel& model) {
  reader.read("min_range_m", model.min_range_m, {0.01, 10.0});
  reader.read("max_range_m", model.max_range_m, {1.0, 1000.0});
  reader.read("range_at_10_percent_m", model.range_at_10_percent_m, {1.0, 1000.0});
  read_scaled(reader, "range_sigma_mm", kMilli, model.range_sigma_m, {0.0, 1000.0});
  read_scaled(reader, "range_sigma_at_limit_mm", kMilli, model.range_sigma_at_limit_m, {0.0, 1000.0});
  read_scaled(reader, "range_resolution_mm", kMilli, model.range_resolution_m, {0.0, 1000.0});
  read_scaled(reader, "ring_bias_sigma_mm", kMilli, model.ring_bias_sigma_m, {0.0, 1000.0});
  read_scaled(reader, "accuracy_sigma_mm", kMilli, model.accuracy_sigma_m, {0.0, 1000.0});
}

void read_optics(ConfigReader& reader, LidarModel& model) {
  read_scaled(reader, "pulse_ns", kNano, model.pulse_s, {0.1, 1000.0});
  read_scaled(reader, "exit_width_mm", kMilli, model.exit_width_m, {0.0, 1000.0});
  read_scaled(reader, "exit_height_mm", kMilli, model.exit_height_m, {0.0, 1000.0});
  read_scaled(reader, "divergence_horizontal_mrad", kMilli, model.divergence_horizontal_rad, {0.01, 100.0});
  read_scaled(reader, "divergence_vertical_mrad", kMilli, model.divergence_vertical_rad, {0.01, 100.0});
}

}  // namespace

LidarModel catalogue_lidar(const std::string& name) {
  LidarModel model;
  model.name = name;
  read_device(name, "lidar", [&](ConfigReader& reader) {
    read_beams(reader, model);
    model.head = read_head(reader);
    reader.read("rate_hz", model.rate_hz, {1.0, 100.0});
    reader.read("encoder_resolution_deg", model.encoder_resolution_deg, {0.0, 10.0});
    read_ranges(reader, model);
    read_optics(reader, model);
  });
  return model;
}

}  // namespace plumbline
