// A robot's program in 20 lines: two seconds at rest, then the pose.
#include <cstdio>

#include "estimator/estimator.h"

int main() {
  plumbline::Calibration calibration;
  calibration.has_camera = false;
  calibration.has_lidar = false;
  const auto estimator = plumbline::make_estimator("imu", calibration, {});
  plumbline::Odometry last;
  for (int i = 1; i <= 400; ++i) {
    estimator->add(plumbline::ImuSample{i * 5'000'000LL, {0.0, 0.0, 0.0}, {0.0, 0.0, 9.81}});
    for (const plumbline::Odometry& odometry : estimator->take()) last = odometry;
  }
  const Eigen::Vector3d& at = last.world_from_body.translation;
  std::printf("%lld ns: %.3f %.3f %.3f m\n", static_cast<long long>(last.stamp_ns), at.x(), at.y(), at.z());
  return last.stamp_ns == 2'000'000'000LL && at.norm() < 0.01 ? 0 : 1;
}
