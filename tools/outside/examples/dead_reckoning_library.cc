// An estimator in a shared library: dead reckoning, after half a second at rest that shows gravity and the gyro's bias.
//
//     c++ -std=c++20 -O2 -shared -fPIC -I PLUMBLINE -I /usr/include/eigen3 -o libmine.so dead_reckoning_library.cc
//
//     plumbline run scenarios/quickstart.yaml --estimator ./libmine.so
//
// PLUMBLINE is the source tree that the program was built from: estimator.h is the interface between both.
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "estimator/estimator.h"

namespace {

constexpr std::int64_t kRest_ns = 500'000'000;
const Eigen::Vector3d kGravity(0.0, 0.0, -9.81);

class DeadReckoning final : public plumbline::Estimator {
 public:
  void add(const plumbline::ImuSample& sample) override {
    if (!sample.angular_rate.allFinite() || !sample.specific_force.allFinite()) {
      ++imu_.dropped["not finite"];
      return;
    }
    if (imu_.used > 0 && sample.stamp_ns <= odometry_.stamp_ns) {
      ++imu_.dropped["back in time"];
      return;
    }
    if (imu_.used == 0) first_ns_ = sample.stamp_ns;
    const double dt = imu_.used == 0 ? 0.0 : 1e-9 * static_cast<double>(sample.stamp_ns - odometry_.stamp_ns);
    ++imu_.used;
    odometry_.stamp_ns = sample.stamp_ns;
    if (sample.stamp_ns - first_ns_ < kRest_ns) {
      rest(sample);
    } else {
      move(sample, dt);
    }
    outputs_.push_back(odometry_);
  }

  // Dead reckoning looks at nothing else.
  void add(const plumbline::CameraFrame&) override { ++vision_.dropped["not looked at"]; }
  void add(const plumbline::DepthFrame&) override { ++vision_.dropped["not looked at"]; }
  void add(const plumbline::LidarScan&) override { ++lidar_.dropped["not looked at"]; }

  std::vector<plumbline::Odometry> take() override {
    std::vector<plumbline::Odometry> taken;
    taken.swap(outputs_);
    return taken;
  }

  plumbline::MessageCounts counts(plumbline::Module module) const override {
    if (module == plumbline::Module::kImu) return imu_;
    return module == plumbline::Module::kVision ? vision_ : lidar_;
  }

 private:
  // At rest the specific force points up, and the gyro reads nothing but its bias.
  void rest(const plumbline::ImuSample& sample) {
    force_ += sample.specific_force;
    rate_ += sample.angular_rate;
    odometry_.gyro_bias = rate_ / static_cast<double>(imu_.used);
    // Yaw 0 is where the estimate starts.
    const Eigen::AngleAxisd roll(std::atan2(force_.y(), force_.z()), Eigen::Vector3d::UnitX());
    const Eigen::AngleAxisd pitch(-std::atan2(force_.x(), force_.tail<2>().norm()), Eigen::Vector3d::UnitY());
    odometry_.world_from_body.rotation = pitch * roll;
  }

  // The sample is the mean over the interval that ends at its stamp.
  void move(const plumbline::ImuSample& sample, double dt) {
    Eigen::Quaterniond& rotation = odometry_.world_from_body.rotation;
    const Eigen::Vector3d turn = (sample.angular_rate - odometry_.gyro_bias) * dt;
    const Eigen::Quaterniond half(Eigen::AngleAxisd(0.5 * turn.norm(), turn.stableNormalized()));
    const Eigen::Vector3d acceleration = (rotation * half) * sample.specific_force + kGravity;
    odometry_.world_from_body.translation += (odometry_.velocity_in_world + 0.5 * acceleration * dt) * dt;
    odometry_.velocity_in_world += acceleration * dt;
    rotation = (rotation * half * half).normalized();
  }

  plumbline::Odometry odometry_;
  std::vector<plumbline::Odometry> outputs_;
  plumbline::MessageCounts imu_, vision_, lidar_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();
  std::int64_t first_ns_ = 0;
};

}  // namespace

// The calibration is YAML, as tools/outside/README.md describes it; dead reckoning needs none of it.
extern "C" plumbline::Estimator* plumbline_make_estimator(const char* /*calibration_yaml*/) {
  return new DeadReckoning();
}
