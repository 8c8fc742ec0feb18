#include "tools/evaluation/flight_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace plumbline {
namespace {

using Eigen::Vector3d;

/// Ten seconds along x at 1 m/s past a way-point every metre; `estimate` and `control` are the errors at a time [s].
RunRecord flight_with(const std::function<Vector3d(double)>& estimate, const std::function<Vector3d(double)>& control) {
  FlightRecord flight;
  for (int i = 0; i <= 10; ++i) flight.waypoints.emplace_back(i, 0.0, 2.0);
  for (int i = 0; i <= 1000; ++i) {
    const double time_s = 0.01 * i;
    FlightSample sample;
    sample.stamp_ns = static_cast<std::int64_t>(i) * 10'000'000;
    sample.wanted = {time_s, 0.0, 2.0};
    sample.estimate_error = estimate(time_s);
    // A craft believed too far left flies too far right.
    sample.flown = sample.wanted - estimate(time_s) + control(time_s);
    sample.clearance_m = 3.0 - 0.1 * time_s;
    flight.samples.push_back(sample);
  }
  flight.end = FlightEnd::kFlown;
  RunRecord record;
  record.flight = flight;
  return record;
}

Vector3d none(double /*time_s*/) { return Vector3d::Zero(); }

std::function<Vector3d(double)> growing_after(double from_s, double mps) {
  return [=](double time_s) { return Vector3d(0.0, mps * std::max(0.0, time_s - from_s), 0.0); };
}

TEST(FlightFigures, NothingForARunInOpenLoop) { EXPECT_FALSE(flight_figures(RunRecord{})); }

TEST(FlightFigures, AFlightAsAskedHasNoFailure) {
  const FlightFigures figures = *flight_figures(flight_with(none, none));
  EXPECT_EQ(figures.waypoints, 11);
  EXPECT_EQ(figures.waypoints_missed, 0);
  EXPECT_EQ(figures.collisions, 0);
  EXPECT_EQ(figures.origin, FailureOrigin::kNone);
  EXPECT_FALSE(figures.failure_since_s);
  EXPECT_NEAR(*figures.tracking_error_max_m, 0.0, 1e-12);
  EXPECT_NEAR(*figures.clearance_min_m, 2.0, 1e-12);
}

TEST(FlightFigures, FailureBeganInTheErrorThatLeftItsBoundFirst) {
  // The estimate's error passes 0.5 m at 6 s, the control's at 8 s; and the other way round.
  const auto early = growing_after(5.0, 0.5);
  const auto late = growing_after(7.0, 0.5);
  const FlightFigures estimate = *flight_figures(flight_with(early, late));
  EXPECT_EQ(estimate.origin, FailureOrigin::kEstimate);
  EXPECT_NEAR(*estimate.failure_since_s, 6.0, 0.011);
  const FlightFigures control = *flight_figures(flight_with(late, early));
  EXPECT_EQ(control.origin, FailureOrigin::kControl);
  EXPECT_NEAR(*control.failure_since_s, 6.0, 0.011);
  EXPECT_NEAR(*control.control_error_max_m, 2.5, 1e-9);
  EXPECT_NEAR(*control.estimate_error_max_m, 1.5, 1e-9);
  // They offset the craft against each other: a metre at the end, 0.5 m from 6 s on.
  EXPECT_NEAR(*control.tracking_error_max_m, 1.0, 1e-9);
  EXPECT_EQ(control.waypoints_missed, 4);
}

TEST(FlightFigures, NeitherErrorAloneCanBeTheReason) {
  const auto right = [](double) { return Vector3d(0.0, -0.3, 0.0); };
  const auto left = [](double) { return Vector3d(0.0, 0.3, 0.0); };
  const FlightFigures figures = *flight_figures(flight_with(right, left));
  EXPECT_EQ(figures.waypoints_missed, 11);
  EXPECT_EQ(figures.origin, FailureOrigin::kNeither);
}

TEST(FlightFigures, AFlightThatEndsEarlyMissesWhatLiesAhead) {
  RunRecord record = flight_with(none, none);
  record.flight->samples.resize(451);
  record.flight->end = FlightEnd::kStruck;
  const FlightFigures figures = *flight_figures(record);
  EXPECT_EQ(figures.collisions, 1);
  // The fifth metre's is 0.5 m ahead of the last sample and counts.
  EXPECT_EQ(figures.waypoints_missed, 5);
  EXPECT_EQ(figures.origin, FailureOrigin::kNeither);
}

TEST(FlightFigures, AWaypointBetweenTwoSamplesIsPassed) {
  RunRecord record = flight_with(none, none);
  std::vector<FlightSample>& samples = record.flight->samples;
  samples = {samples.front(), samples.back()};  // 10 m apart
  EXPECT_EQ(flight_figures(record)->waypoints_missed, 0);
}

}  // namespace
}  // namespace plumbline
