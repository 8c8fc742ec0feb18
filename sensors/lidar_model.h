#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace plumbline {

inline constexpr double kSpeedOfLight_mps = 299792458.0;

/// A laser and its receiver on the turning head, x ahead, y left, z along the axis.
struct LidarBeam {
  double elevation_deg = 0.0;      ///< above the plane square to the axis
  double azimuth_deg = 0.0;        ///< from the head's x axis, counter-clockwise seen from above
  double vertical_offset_m = 0.0;  ///< of its origin along the axis
  double firing_s = 0.0;           ///< since the start of a firing cycle
};

/// A multi-beam head (Velodyne) whose lasers fire by a clock of their own: cycles follow each other without regard to
/// the revolution, so a revolution begins and ends within one.
struct SpinningHead {
  double cycle_s = 55.296e-6;
};

/// A multi-beam head (Ouster) that fires all lasers at once, at fixed encoder positions.
struct ColumnHead {
  int columns = 1024;          ///< per revolution
  double beam_origin_m = 0.0;  ///< beams start this far from the axis, towards the head's azimuth
};

/// A line scanner (Hokuyo) that a motor turns about the scanner's forward axis. At joint angle 0 the scanner's plane is
/// the lidar frame's x-y plane; a sweep is half a turn of the joint, after which every direction was covered once.
struct TwoAxisHead {
  double line_rate_hz = 40.0;
  int steps_per_turn = 1440;       ///< of the mirror, counter-clockwise seen from above
  int first_step = 180;            ///< read per line
  int last_step = 900;             ///< both included
  int front_step = 540;            ///< looks along x
  bool continuous = false;         ///< the joint goes on turning; otherwise back and forth between -90 and 90 degrees
  double joint_deg_per_s = 180.0;  ///< at reversals instantly turned round
};

using LidarHead = std::variant<SpinningHead, ColumnHead, TwoAxisHead>;

/// A lidar as its data sheet describes it.
struct LidarModel {
  std::string name = "vlp16";
  std::vector<LidarBeam> beams;  ///< in firing order
  LidarHead head;
  double rate_hz = 10.0;                ///< messages: revolutions of a spinning head, parts of a sweep of a 2-axis one
  double encoder_resolution_deg = 0.0;  ///< of the reported azimuth, or of the joint's angle of a 2-axis head; 0: exact
  double min_range_m = 0.5;
  double max_range_m = 100.0;

  double range_at_10_percent_m = 50.0;   ///< a plate of 10 % reflectivity, seen head-on, is found half of the time here
  double range_sigma_m = 0.006;          ///< white noise of a return in full light
  double range_sigma_at_limit_m = 0.08;  ///< white noise of a return as weak as that of the plate
  double range_resolution_m = 0.002;
  double ring_bias_sigma_m = 0.0;   ///< constant per laser, drawn per seed
  double accuracy_sigma_m = 0.015;  ///< the data sheet's, all errors of a range together: what users know

  double pulse_s = 5e-9;  ///< full width at half maximum
  /// The beam's full width, where the intensity is 1/e^2 of the axis's: horizontally and vertically.
  double exit_width_m = 0.01;
  double exit_height_m = 0.01;
  double divergence_horizontal_rad = 3e-3;
  double divergence_vertical_rad = 1.5e-3;
};

/// Velodyne VLP-16 as in sensors/catalogue/vlp16.yaml.
LidarModel vlp16();

/// @throws std::invalid_argument naming the field that is out of range.
void validate_or_throw(const LidarModel& model);

/// Length of a message.
std::int64_t message_period_ns(const LidarModel& model);

/// Messages that make up a sweep: 1 but for 2-axis heads.
int messages_per_sweep(const LidarModel& model);

/// Rings that LidarPoint::ring counts: beams, or lines per sweep of a 2-axis head.
int ring_count(const LidarModel& model);

}  // namespace plumbline
