#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sensors/imu.h"
#include "tools/verify/allan.h"

namespace plumbline {

/// A unit's gyroscopes or accelerometers held against their figures.
struct TriadCheck {
  NoiseFigures figures;
  std::array<std::vector<AllanPoint>, 3> curves;  ///< of a two-hour log at rest with every effect on, per axis
  std::vector<AllanExpectation> expected;         ///< at the same averaging times
  std::vector<AllanBand> band;                    ///< each point lies within with a probability of 95 %
  std::vector<AllanBand> joint_band;         ///< all points of all units' curves lie within with a probability of 95 %
  std::array<double, 3> density{};           ///< given back by the two-hour log
  std::array<double, 3> bias_instability{};  ///< given back by a log of flicker noise alone, eight hours
  std::array<double, 3> random_walk{};       ///< given back by a log of random walk alone, two hours
};

struct ImuCheck {
  ImuModel model;
  TriadCheck gyro;
  TriadCheck accel;
};

/// Simulates the logs of a unit and evaluates them.
/// @param units  how many are checked: the joint band is wider for more
/// @param catalogue_seed  each unit draws from one of its own, derived from its name
ImuCheck check_imu(const ImuModel& model, std::size_t units, std::uint64_t catalogue_seed);

/// Largest relative difference of what logs gave back to the figure.
double worst_error(const std::array<double, 3>& given_back, double figure);

/// Share of the curves' points that lie within a band, of 3 x size points.
double share_within(const TriadCheck& check, const std::vector<AllanBand>& band);

}  // namespace plumbline
