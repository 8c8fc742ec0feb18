#pragma once

namespace plumbline {

inline constexpr double kDegree = 3.14159265358979323846 / 180.0;  // [rad]
inline constexpr double kGravity = 9.81;                           // [m/s^2], the simulated world's

}  // namespace plumbline
