#include "sim/scenes/garage_bays.h"

#include <cmath>
#include <string>

#include "sim/scenes/parked_things.h"

namespace plumbline {
namespace {

struct Bay {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // on its ground
  std::string name;                                  // of its random stream
};

void fill_bay(MjcfWriter& writer, const GaragePlan& plan, const Bay& bay) {
  RandomStream stream(plan.seed, bay.name);
  if (stream.uniform() >= plan.clutter) return;
  const double yaw = stream.uniform() < 0.5 ? 0.0 : M_PI;  // nose in or nose out
  add_parked_thing(writer, stream, upright_frame(bay.middle, yaw));
}

void add_bay_line(MjcfWriter& writer, double x, double y_from, double y_to) {
  writer.box("road_paint", {x - 0.05, y_from, 0.0}, {x + 0.05, y_to, 0.004});
}

// A sloping slab in a corner, rising away from the hall's west end.
void add_ramp(MjcfWriter& writer, double west, double y_front, double y_back) {
  constexpr double kLength = 4.5;
  constexpr double kSlope = 0.17;
  const Eigen::Quaterniond up_slope(Eigen::AngleAxisd(-kSlope, Eigen::Vector3d::UnitY()));
  writer.box("concrete_dark", {0.0, y_front, -0.2}, {kLength, y_back, 0.0}, {up_slope, {west, 0.0, 0.0}});
  writer.box("sign_yellow", {west, y_front, 0.0}, {west + kLength, y_front + 0.1, 0.9});
}

void add_wall_bays(MjcfWriter& writer, const GaragePlan& plan, int hall, double side) {
  constexpr int kRampBays = 2;  // at the west end of the north wall
  const int count = static_cast<int>((plan.length - 1.0) / GaragePlan::kBayPitchM);
  const double west = plan.west_of(hall) + (plan.length - count * GaragePlan::kBayPitchM) / 2.0;
  const double front = plan.bay_front();
  const int first = side > 0.0 ? kRampBays : 0;
  if (first > 0) add_ramp(writer, west + 0.5, front + 0.3, plan.half_width());
  for (int i = first; i < count; ++i) {
    const double x = west + i * GaragePlan::kBayPitchM;
    if (i % 2 == 0)
      add_bay_line(writer, x, std::min(side * front, side * (front + 4.5)),
                   std::max(side * front, side * (front + 4.5)));
    fill_bay(writer, plan,
             {{x + GaragePlan::kBayPitchM / 2.0, side * (plan.half_width() - kParkedLengthM / 2.0 - 0.1), 0.0},
              "garage/hall" + std::to_string(hall) + (side > 0.0 ? "/north" : "/south") + std::to_string(i)});
  }
}

bool is_at_pillar(const GaragePlan& plan, double x_in_hall) {
  for (const double row : plan.pillar_rows()) {
    if (std::abs(row - x_in_hall) < kParkedWidthM / 2.0 + 0.25) return true;
  }
  return false;
}

// A kerb around, things on it in the gaps between the pillars.
void add_island(MjcfWriter& writer, const GaragePlan& plan, int hall) {
  const double west = plan.west_of(hall);
  const double begin = GaragePlan::kIslandInsetM;
  const double end = plan.length - GaragePlan::kIslandInsetM;
  writer.box("concrete_pale", {west + begin, -GaragePlan::kIslandHalfM, 0.0},
             {west + end, GaragePlan::kIslandHalfM, GaragePlan::kKerbM});
  const int count = static_cast<int>((end - begin) / GaragePlan::kBayPitchM);
  for (int i = 0; i < count; ++i) {
    const double x = begin + (end - begin) * (i + 0.5) / count;
    if (is_at_pillar(plan, x)) continue;
    fill_bay(
        writer, plan,
        {{west + x, 0.0, GaragePlan::kKerbM}, "garage/hall" + std::to_string(hall) + "/island" + std::to_string(i)});
  }
}

}  // namespace

void add_bays(MjcfWriter& writer, const GaragePlan& plan, int hall) {
  add_wall_bays(writer, plan, hall, +1.0);
  add_wall_bays(writer, plan, hall, -1.0);
  add_island(writer, plan, hall);
}

}  // namespace plumbline
