#include "sim/vehicles/wheeled.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/band_limiter.h"
#include "sim/vehicles/chassis.h"
#include "sim/vehicles/driver.h"

namespace plumbline {
namespace {

constexpr double kStep_s = Chassis::kStep_s;
static_assert(Chassis::kStep_s == BandLimiter::kStep_s);
constexpr double kSettle_s = 1.5;   // on the suspension, before time 0 and after the end
constexpr double kOffPath_m = 1.5;  // further off, the vehicle has not followed
constexpr double kBehind_m = 25.0;  // the same along the path

std::string metres(double value) {
  std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 2) + " m";
}

[[noreturn]] void fail(const WheeledDesign& design, const std::string& what) {
  throw std::invalid_argument("motion: the " + design.name + " " + what);
}

void check_turns(const WheeledDesign& design, const Path& path) {
  for (double along_m = 0.0; along_m <= path.length_m(); along_m += Path::kStep_m) {
    const double radius_m = 1.0 / std::max(std::abs(path.at(along_m).turn()), 1e-9);
    if (radius_m >= design.least_radius_m) continue;
    fail(design, "cannot turn as tightly as its path does " + metres(along_m) + " from the start: a radius of " +
                     metres(radius_m) + ", it needs " + metres(design.least_radius_m));
  }
}

/// On its wheels at the path's start.
Pose standing(const WheeledDesign& design, const Path& path, Ground& ground) {
  const PathPoint start = path.at(0.0);
  Pose pose;
  pose.rotation =
      rotation_from_rpy({0.0, -std::atan2(start.tangent.z(), start.tangent.head<2>().norm()), start.heading()});
  pose.translation = start.position;
  pose.translation.z() =
      ground.height(start.position.x(), start.position.y(), start.position.z()) + design.tyre.radius_m;
  return pose;
}

/// A vehicle under way.
class Drive {
 public:
  Drive(const WheeledDesign& design, const Path& path, const Course& course, Ground& ground)
      : design_(design),
        path_(path),
        ground_(ground),
        chassis_(design, standing(design, path, ground)),
        driver_(path, course, design),
        tyres_(4, Tyre(design.tyre)) {
    if (design.steering == WheeledDesign::Steering::kPushed) {
      TyreDesign castor = design.tyre;
      castor.castor = true;
      tyres_[0] = tyres_[1] = Tyre(castor);
    }
  }

  void step(double time_s) {
    chassis_.begin_step();
    const Pose pose = chassis_.pose();
    const Eigen::Vector3d ahead = pose.rotation * Eigen::Vector3d::UnitX();
    const DriverView view{pose.translation, std::atan2(ahead.y(), ahead.x()), chassis_.velocity().dot(ahead)};
    const DriverCommand command = driver_.decide(time_s, view);
    if (design_.steering == WheeledDesign::Steering::kPushed) {
      push(command, view);
    } else {
      drive_and_brake(command, view);
      steer(command);
    }
    const double route_z = path_.at(driver_.along_m()).position.z();
    for (int i = 0; i < 4; ++i) {
      chassis_.push_wheel(i, tyres_[static_cast<std::size_t>(i)].step(chassis_.wheel(i), ground_, route_z, kStep_s));
    }
    if (view.speed_mps != 0.0) {
      const double drag_n = design_.drag * view.speed_mps * std::abs(view.speed_mps);
      chassis_.push(-drag_n * ahead, Eigen::Vector3d::Zero(), pose * design_.centre_of_mass);
    }
    chassis_.finish_step();
  }

  void check_on_path(double wanted_m) const {
    const Eigen::Vector3d up = chassis_.pose().rotation * Eigen::Vector3d::UnitZ();
    if (up.z() < 0.5) fail(design_, "fell over " + metres(driver_.along_m()) + " from its path's start");
    if (std::abs(driver_.off_path_m()) > kOffPath_m) {
      fail(design_, "left its path " + metres(driver_.along_m()) + " from the start; lower speed_mps or " +
                        "lateral_acceleration_mps2");
    }
    if (std::abs(wanted_m - driver_.along_m()) > kBehind_m) {
      fail(design_, "cannot keep up " + metres(driver_.along_m()) + " from its path's start; lower speed_mps or " +
                        "acceleration_mps2");
    }
  }

  Pose world_from_pack() const {
    return chassis_.pose() * Pose{Eigen::Quaterniond::Identity(), design_.pack_in_chassis};
  }

 private:
  double total_kg() const { return design_.mass_kg + 4.0 * design_.wheel_kg; }

  double wanted_force(const DriverCommand& command, const DriverView& view) const {
    return total_kg() * command.acceleration_mps2 + design_.drag * view.speed_mps * std::abs(view.speed_mps) +
           design_.tyre.rolling_resistance * total_kg() * 9.81 * std::tanh(view.speed_mps / 0.2);
  }

  void drive_and_brake(const DriverCommand& command, const DriverView& view) {
    constexpr double kFrontBrakes = 0.6;
    const double most_n = std::min(design_.drive_n, design_.power_w / std::max(view.speed_mps, 1.0));
    const double force_n = std::clamp(wanted_force(command, view), -design_.brake_n, most_n);
    const double front = force_n < 0.0 ? kFrontBrakes : (design_.four_wheel_drive ? 0.5 : 0.0);
    for (int i = 0; i < 4; ++i) {
      chassis_.drive_wheel(i, 0.5 * force_n * (i < 2 ? front : 1.0 - front) * design_.tyre.radius_m);
    }
  }

  void steer(const DriverCommand& command) {
    constexpr double kRate = 1.2;  // of the turn's middle wheel angle [rad/s]
    constexpr double kLag_s = 0.05;
    const double wanted = std::atan(design_.wheelbase_m * command.turn);
    angle_ += std::clamp((wanted - angle_) * kStep_s / kLag_s, -kRate * kStep_s, kRate * kStep_s);
    const double turn = std::tan(angle_) / design_.wheelbase_m;
    const auto wheel_angle = [&](double left_m) { return std::atan2(design_.wheelbase_m * turn, 1.0 - turn * left_m); };
    chassis_.steer(wheel_angle(0.5 * design_.track_m), wheel_angle(-0.5 * design_.track_m));
  }

  /// The handle is pushed with every step a little more, and turned so that the cart comes round.
  void push(const DriverCommand& command, const DriverView& view) {
    constexpr double kTurnRate_hz = 4.0;
    const Pose pose = chassis_.pose();
    const double steps = std::sin(step_phase_);
    const double wish_n = wanted_force(command, view) +
                          design_.step_share * design_.drive_n * steps * std::clamp(view.speed_mps, 0.0, 1.0);
    const double force_n = std::clamp(wish_n, -design_.brake_n, design_.drive_n);
    const double yaw_rate = chassis_.turn_rate().z();
    const double couple_nm = design_.inertia.z() * 3.0 * kTurnRate_hz * (view.speed_mps * command.turn - yaw_rate);
    chassis_.push(force_n * (pose.rotation * Eigen::Vector3d::UnitX()), couple_nm * Eigen::Vector3d::UnitZ(),
                  pose * design_.handle_in_chassis);
    step_phase_ += 2.0 * M_PI * design_.step_frequency_hz * kStep_s;
  }

  const WheeledDesign& design_;
  const Path& path_;
  Ground& ground_;
  Chassis chassis_;
  Driver driver_;
  std::vector<Tyre> tyres_;
  double angle_ = 0.0;
  double step_phase_ = 0.0;
};

}  // namespace

Trajectory drive_wheeled(const WheeledDesign& design, const MotionConfig& config, const World& world,
                         const RayScene& rays, std::uint64_t seed) {
  const Path path(points_of(config, world), design.path_smoothing_m);
  check_turns(design, path);
  const Course course = course_along(path, config, Turning::kOnGround);
  Ground ground(world, rays, design.ground_cell_m, config.roughness_m, seed);
  Drive drive(design, path, course, ground);
  for (double t = 0.0; t < kSettle_s; t += kStep_s) drive.step(0.0);

  BandLimiter motion;
  constexpr std::size_t kStepsPerKnot = static_cast<std::size_t>(Course::kStep_s / kStep_s + 0.5);
  const auto end = static_cast<std::size_t>(kSettle_s / kStep_s) + (course.along_m.size() - 1) * kStepsPerKnot;
  for (std::size_t i = 0; i <= end; ++i) {
    motion.add(drive.world_from_pack());
    drive.step(static_cast<double>(i) * kStep_s);
    if (i % kStepsPerKnot == 0) {
      drive.check_on_path(course.along_m[std::min(i / kStepsPerKnot, course.along_m.size() - 1)]);
    }
  }
  return motion.finish();
}

}  // namespace plumbline
