#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scenarios/run_record.h"

namespace plumbline {

/// A way-point counts as reached, and an error as within its bound, up to here.
inline constexpr double kWaypointReach_m = 0.5;

/// Where a flight that failed went wrong first.
enum class FailureOrigin {
  kNone,      ///< it did not fail
  kEstimate,  ///< the estimate left its bound first
  kControl,   ///< the control did, with an estimate that was still good
  kNeither    ///< neither did by itself: their sum was too much, or something stood too near
};
std::string to_string(FailureOrigin origin);
std::string to_string(FlightEnd end);

/// How a flight in closed loop went, by the truth.
struct FlightFigures {
  FlightEnd end = FlightEnd::kCut;
  std::int64_t waypoints = 0;
  std::int64_t waypoints_missed = 0;  ///< not passed within kWaypointReach_m
  std::int64_t collisions = 0;        ///< a flight ends with its first
  std::optional<double> clearance_min_m;
  std::optional<double> tracking_error_rms_m;  ///< of the craft from where the mission wants it
  std::optional<double> tracking_error_max_m;
  /// Of the estimate that the controller had, at its own stamp, laid out from the pad.
  std::optional<double> estimate_error_max_m;
  /// What is left of the tracking error when the estimate's is taken out: a perfect control leaves nothing.
  std::optional<double> control_error_max_m;
  FailureOrigin origin = FailureOrigin::kNone;
  std::optional<double> failure_since_s;  ///< when the first error left its bound, since the run's start
};

double tracking_error_m(const FlightSample& sample);
double control_error_m(const FlightSample& sample);

/// Nothing for a run that was no flight in closed loop.
std::optional<FlightFigures> flight_figures(const RunRecord& record);

}  // namespace plumbline
