#include "sim/scenes/stairs.h"

#include <algorithm>
#include <cmath>

namespace plumbline {
namespace {

constexpr double kMaxRiserM = 0.18;
constexpr double kThicknessM = 0.2;
constexpr double kRailHeightM = 0.95;

}  // namespace

int riser_count(double rise_m, int multiple) {
  return multiple * static_cast<int>(std::ceil(rise_m / kMaxRiserM / multiple - 1e-9));
}

void add_flight(MjcfWriter& writer, const std::string& material, const Flight& flight, const Pose& world_from_flight,
                bool left_rail, bool right_rail) {
  constexpr double kNosingM = 0.03;
  const double y = flight.width_m / 2.0;
  for (int i = 1; i < flight.risers; ++i) {
    const double top = i * flight.riser_m();
    writer.box(material, {(i - 1) * flight.tread_m - kNosingM, -y, top - kThicknessM}, {i * flight.tread_m, y, top},
               world_from_flight);
  }
  const Eigen::Vector3d top(flight.run_m(), 0.0, flight.rise_m - flight.riser_m());
  const Eigen::Vector3d inset(0.0, y - 0.04, 0.0);
  if (left_rail) add_rail(writer, inset, top + inset, world_from_flight);
  if (right_rail) add_rail(writer, -inset, top - inset, world_from_flight);
}

void add_rail(MjcfWriter& writer, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
              const Pose& world_from_local) {
  constexpr double kPostSpacingM = 1.0;
  const Eigen::Vector3d up(0.0, 0.0, kRailHeightM);
  writer.capsule("wood_dark", from + up, to + up, 0.025, world_from_local);
  const int gaps = std::max(1, static_cast<int>(std::lround((to - from).norm() / kPostSpacingM)));
  for (int i = 0; i <= gaps; ++i) {
    const Eigen::Vector3d foot = from + (to - from) * i / gaps;
    writer.cylinder("steel", foot, foot + up, 0.015, world_from_local);
  }
}

}  // namespace plumbline
