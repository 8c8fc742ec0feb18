#include "tools/evaluation/flight_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace plumbline {
namespace {

double distance_to_leg(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d leg = b - a;
  const double ratio = std::clamp((point - a).dot(leg) / std::max(leg.squaredNorm(), 1e-12), 0.0, 1.0);
  return (point - a - ratio * leg).norm();
}

double distance_to_flight(const Eigen::Vector3d& waypoint, const std::vector<FlightSample>& samples) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d& before = samples[i == 0 ? 0 : i - 1].flown;
    nearest_m = std::min(nearest_m, distance_to_leg(waypoint, before, samples[i].flown));
  }
  return nearest_m;
}

void add_origin(FlightFigures& figures, const std::vector<FlightSample>& samples) {
  if (figures.end == FlightEnd::kFlown && figures.waypoints_missed == 0) return;
  figures.origin = FailureOrigin::kNeither;
  for (const FlightSample& sample : samples) {
    const double estimate_m = sample.estimate_error.norm();
    const double control_m = control_error_m(sample);
    if (std::max(estimate_m, control_m) <= kWaypointReach_m) continue;
    figures.origin = estimate_m >= control_m ? FailureOrigin::kEstimate : FailureOrigin::kControl;
    figures.failure_since_s = static_cast<double>(sample.stamp_ns) * 1e-9;
    return;
  }
}

}  // namespace

std::string to_string(FailureOrigin origin) {
  switch (origin) {
    case FailureOrigin::kNone:
      return "none";
    case FailureOrigin::kEstimate:
      return "estimate";
    case FailureOrigin::kControl:
      return "control";
    case FailureOrigin::kNeither:
      break;
  }
  return "neither";
}

std::string to_string(FlightEnd end) {
  switch (end) {
    case FlightEnd::kFlown:
      return "flown";
    case FlightEnd::kStruck:
      return "struck";
    case FlightEnd::kAstray:
      return "astray";
    case FlightEnd::kCut:
      break;
  }
  return "cut";
}

double tracking_error_m(const FlightSample& sample) { return (sample.flown - sample.wanted).norm(); }

double control_error_m(const FlightSample& sample) {
  return (sample.flown - sample.wanted + sample.estimate_error).norm();
}

std::optional<FlightFigures> flight_figures(const RunRecord& record) {
  if (!record.flight) return std::nullopt;
  const FlightRecord& flight = *record.flight;
  FlightFigures figures;
  figures.end = flight.end;
  figures.collisions = flight.end == FlightEnd::kStruck ? 1 : 0;
  figures.waypoints = static_cast<std::int64_t>(flight.waypoints.size());
  figures.waypoints_missed = std::count_if(
      flight.waypoints.begin(), flight.waypoints.end(),
      [&](const Eigen::Vector3d& waypoint) { return distance_to_flight(waypoint, flight.samples) > kWaypointReach_m; });
  add_origin(figures, flight.samples);
  if (flight.samples.empty()) return figures;

  double squares = 0.0;
  double tracking_m = 0.0;
  double estimate_m = 0.0;
  double control_m = 0.0;
  double clearance_m = kMostClearance_m;
  for (const FlightSample& sample : flight.samples) {
    squares += (sample.flown - sample.wanted).squaredNorm();
    tracking_m = std::max(tracking_m, tracking_error_m(sample));
    estimate_m = std::max(estimate_m, sample.estimate_error.norm());
    control_m = std::max(control_m, control_error_m(sample));
    clearance_m = std::min(clearance_m, sample.clearance_m);
  }
  figures.tracking_error_rms_m = std::sqrt(squares / static_cast<double>(flight.samples.size()));
  figures.tracking_error_max_m = tracking_m;
  figures.estimate_error_max_m = estimate_m;
  figures.control_error_max_m = control_m;
  figures.clearance_min_m = clearance_m;
  return figures;
}

}  // namespace plumbline
