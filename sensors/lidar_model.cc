#include "sensors/lidar_model.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace plumbline {
namespace {

[[noreturn]] void refuse(const LidarModel& model, const std::string& field, double found, const std::string& allowed) {
  std::ostringstream text;
  text << "lidar model '" << model.name << "': " << field << " is " << found << ", allowed: " << allowed;
  throw std::invalid_argument(text.str());
}

// Written so that NaN is refused as well.
void require(bool holds, const LidarModel& model, const std::string& field, double found, const std::string& allowed) {
  if (!holds) refuse(model, field, found, allowed);
}

void require_not_negative(const LidarModel& model, const std::string& field, double found) {
  require(found >= 0.0 && std::isfinite(found), model, field, found, "0 or more");
}

std::string indexed(const std::string& field, std::size_t index) {
  return std::string(field).append("[").append(std::to_string(index)).append("]");
}

void require_positive(const LidarModel& model, const std::string& field, double found) {
  require(found > 0.0 && std::isfinite(found), model, field, found, "more than 0");
}

bool is_whole(double number) { return std::abs(number - std::round(number)) < 1e-9 * std::max(1.0, number); }

double sweep_s(const TwoAxisHead& head) { return 180.0 / head.joint_deg_per_s; }

/// What only some heads have.
class HeadCheck {
 public:
  explicit HeadCheck(const LidarModel& model) : model_(model) {}

  void operator()(const SpinningHead& head) const {
    require(head.cycle_s >= 1e-7 && head.cycle_s <= 1.0 / model_.rate_hz, model_, "cycle_s", head.cycle_s,
            "1e-7 to one revolution");
    require_beams_within(head.cycle_s);
  }
  void operator()(const ColumnHead& head) const {
    require(head.columns >= 16 && head.columns <= 65536, model_, "columns", head.columns, "16 to 65536");
    require_not_negative(model_, "beam_origin_m", head.beam_origin_m);
    require_beams_within(1.0 / (model_.rate_hz * head.columns));
  }
  void operator()(const TwoAxisHead& head) const {
    require(model_.beams.size() == 1, model_, "beams' number", static_cast<double>(model_.beams.size()),
            "1 of a line scanner");
    require(head.line_rate_hz >= 1.0 && head.line_rate_hz <= 10000.0, model_, "line_rate_hz", head.line_rate_hz,
            "1 to 10000");
    require(head.steps_per_turn >= 16 && head.steps_per_turn <= 65536, model_, "steps_per_turn", head.steps_per_turn,
            "16 to 65536");
    require(head.first_step >= 0, model_, "first_step", head.first_step, "0 or more");
    require(head.last_step >= head.first_step && head.last_step < head.steps_per_turn, model_, "last_step",
            head.last_step, "from first_step to below steps_per_turn");
    require(head.joint_deg_per_s > 0.0 && head.joint_deg_per_s <= 3600.0, model_, "joint_deg_per_s",
            head.joint_deg_per_s, "above 0, to 3600");
    require(is_whole(head.line_rate_hz / model_.rate_hz), model_, "rate_hz", model_.rate_hz,
            "a whole number of lines each message");
    require(is_whole(model_.rate_hz * sweep_s(head)), model_, "joint_deg_per_s", head.joint_deg_per_s,
            "a whole number of messages each half turn");
    require_beams_within(1.0 / (head.line_rate_hz * head.steps_per_turn));
  }

 private:
  void require_beams_within(double cycle_s) const {
    double previous = 0.0;
    for (std::size_t i = 0; i < model_.beams.size(); ++i) {
      const double firing_s = model_.beams[i].firing_s;
      require(firing_s >= previous && firing_s < cycle_s, model_, indexed("firing_s", i), firing_s,
              "not before the laser ahead of it, and before the cycle's end");
      previous = firing_s;
    }
  }

  const LidarModel& model_;
};

void require_beams(const LidarModel& model) {
  const std::size_t count = model.beams.size();
  require(count >= 1 && count <= 1024, model, "beams' number", static_cast<double>(count), "1 to 1024");
  for (std::size_t i = 0; i < count; ++i) {
    const LidarBeam& beam = model.beams[i];
    require(std::abs(beam.elevation_deg) < 90.0, model, indexed("elevation_deg", i), beam.elevation_deg,
            "-90 to 90, both excluded");
    require(std::abs(beam.azimuth_deg) <= 180.0, model, indexed("azimuth_deg", i), beam.azimuth_deg, "-180 to 180");
    require(std::isfinite(beam.vertical_offset_m), model, indexed("vertical_offset_m", i), beam.vertical_offset_m,
            "finite");
  }
}

}  // namespace

LidarModel vlp16() {
  constexpr double kElevation_deg[16] = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  constexpr double kVerticalOffset_mm[16] = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                             5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
  LidarModel model;
  for (int laser = 0; laser < 16; ++laser)
    model.beams.push_back({kElevation_deg[laser], 0.0, 1e-3 * kVerticalOffset_mm[laser], 2.304e-6 * laser});
  model.encoder_resolution_deg = 0.01;
  model.ring_bias_sigma_m = 0.01;
  model.exit_width_m = 0.0127;
  model.exit_height_m = 0.0095;
  return model;
}

void validate_or_throw(const LidarModel& model) {
  // Returns are stamped in 32 bits of nanoseconds since the scan's start.
  require(model.rate_hz >= 0.5 && model.rate_hz <= 1000.0, model, "rate_hz", model.rate_hz, "0.5 to 1000");
  require_beams(model);
  std::visit(HeadCheck(model), model.head);
  require(model.encoder_resolution_deg >= 0.0 && model.encoder_resolution_deg <= 10.0, model, "encoder_resolution_deg",
          model.encoder_resolution_deg, "0 to 10");
  require_not_negative(model, "min_range_m", model.min_range_m);
  require(model.max_range_m > model.min_range_m && std::isfinite(model.max_range_m), model, "max_range_m",
          model.max_range_m, "more than min_range_m");
  require_positive(model, "range_at_10_percent_m", model.range_at_10_percent_m);
  require_not_negative(model, "range_sigma_m", model.range_sigma_m);
  require_not_negative(model, "range_sigma_at_limit_m", model.range_sigma_at_limit_m);
  require_not_negative(model, "range_resolution_m", model.range_resolution_m);
  require_not_negative(model, "ring_bias_sigma_m", model.ring_bias_sigma_m);
  require_not_negative(model, "accuracy_sigma_m", model.accuracy_sigma_m);
  require(model.pulse_s > 0.0 && model.pulse_s <= 1e-6, model, "pulse_s", model.pulse_s, "above 0, to 1e-6");
  require_not_negative(model, "exit_width_m", model.exit_width_m);
  require_not_negative(model, "exit_height_m", model.exit_height_m);
  require_positive(model, "divergence_horizontal_rad", model.divergence_horizontal_rad);
  require_positive(model, "divergence_vertical_rad", model.divergence_vertical_rad);
}

std::int64_t message_period_ns(const LidarModel& model) { return std::llround(1e9 / model.rate_hz); }

int messages_per_sweep(const LidarModel& model) {
  const auto* head = std::get_if<TwoAxisHead>(&model.head);
  return head ? static_cast<int>(std::lround(model.rate_hz * sweep_s(*head))) : 1;
}

int ring_count(const LidarModel& model) {
  const auto* head = std::get_if<TwoAxisHead>(&model.head);
  return head ? static_cast<int>(std::lround(head->line_rate_hz * sweep_s(*head)))
              : static_cast<int>(model.beams.size());
}

}  // namespace plumbline
