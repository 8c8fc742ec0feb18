#include <cmath>
#include <sstream>
#include <stdexcept>

#include "sensors/lidar.h"

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

void require_lasers(const LidarModel& model) {
  const std::size_t count = model.elevation_deg.size();
  require(count >= 1 && count <= 1024, model, "elevation_deg's length", static_cast<double>(count), "1 to 1024");
  const auto same_length = [&](const std::vector<double>& values, const std::string& field) {
    require(values.size() == count, model, field + "'s length", static_cast<double>(values.size()),
            "that of elevation_deg, " + std::to_string(count));
  };
  same_length(model.vertical_offset_m, "vertical_offset_m");
  same_length(model.laser_offset_s, "laser_offset_s");
  double previous = 0.0;
  for (std::size_t laser = 0; laser < count; ++laser) {
    const std::string index = std::string("[").append(std::to_string(laser)).append("]");
    require(std::abs(model.elevation_deg[laser]) < 90.0, model, "elevation_deg" + index, model.elevation_deg[laser],
            "-90 to 90, both excluded");
    require(std::isfinite(model.vertical_offset_m[laser]), model, "vertical_offset_m" + index,
            model.vertical_offset_m[laser], "finite");
    const double offset = model.laser_offset_s[laser];
    require(offset >= previous && offset < model.cycle_s, model, "laser_offset_s" + index, offset,
            "not before the laser ahead of it, and before the cycle's end");
    previous = offset;
  }
}

}  // namespace

LidarModel vlp16() {
  LidarModel model;
  model.elevation_deg = {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15};
  model.vertical_offset_m = {11.2e-3, -0.7e-3, 9.7e-3, -2.2e-3, 8.1e-3, -3.7e-3, 6.6e-3, -5.1e-3,
                             5.1e-3,  -6.6e-3, 3.7e-3, -8.1e-3, 2.2e-3, -9.7e-3, 0.7e-3, -11.2e-3};
  for (int laser = 0; laser < 16; ++laser) model.laser_offset_s.push_back(2.304e-6 * laser);
  return model;
}

void validate_or_throw(const LidarModel& model) {
  // Returns are stamped in 32 bits of nanoseconds since the scan's start.
  require(model.rate_hz >= 0.5 && model.rate_hz <= 1000.0, model, "rate_hz", model.rate_hz, "0.5 to 1000");
  require(model.cycle_s >= 1e-7 && model.cycle_s <= 1.0 / model.rate_hz, model, "cycle_s", model.cycle_s,
          "1e-7 to one revolution");
  require_lasers(model);
  require(model.min_range_m >= 0.0, model, "min_range_m", model.min_range_m, "0 or more");
  require(model.max_range_m > model.min_range_m && std::isfinite(model.max_range_m), model, "max_range_m",
          model.max_range_m, "more than min_range_m");
  require(model.range_at_10_percent_m > 0.0, model, "range_at_10_percent_m", model.range_at_10_percent_m,
          "more than 0");
  require(model.range_sigma_m >= 0.0 && std::isfinite(model.range_sigma_m), model, "range_sigma_m", model.range_sigma_m,
          "0 or more");
  require(model.range_resolution_m >= 0.0 && std::isfinite(model.range_resolution_m), model, "range_resolution_m",
          model.range_resolution_m, "0 or more");
  require(model.ring_bias_sigma_m >= 0.0 && std::isfinite(model.ring_bias_sigma_m), model, "ring_bias_sigma_m",
          model.ring_bias_sigma_m, "0 or more");
}

}  // namespace plumbline
