#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "scenarios/calibration.h"
#include "tools/formats/dataset.h"

namespace plumbline {

/// A calibration with every kind of sensor, of numbers that no short text holds.
inline Calibration synthetic_calibration() {
  Calibration calibration;
  calibration.imu_rate_hz = 200.0;
  calibration.imu.gyro_density = 1e-4 / 3.0;
  calibration.camera = {16, 12, 20.0 / 3.0, 20.5 / 3.0, 7.5, 5.5, {-0.2, 0.05, 1e-3, -2e-3}};
  calibration.body_from_camera = {body_from_optical_rotation(), {0.1, 1.0 / 3.0, 0.0}};
  Pose right = calibration.body_from_camera;
  right.translation += right.rotation * Eigen::Vector3d(0.11, 0.0, 0.0);
  calibration.further_cameras.push_back({kRightCamera, right, calibration.camera, 20.0});
  calibration.further_cameras.push_back({kDepthCamera, calibration.body_from_camera, calibration.camera, 20.0});
  calibration.body_from_lidar = {rotation_from_rpy({0.01, 0.1, -0.3}), {0.0, 0.0, 0.1}};
  calibration.lidar_rings = 4;
  return calibration;
}

/// A revolution of four rings clockwise from the rear, with a gap in which nothing returns.
inline LidarScan synthetic_scan(std::int64_t start_ns, std::int64_t duration_ns, int columns) {
  LidarScan scan;
  scan.stamp_ns = start_ns;
  scan.end_ns = start_ns + duration_ns;
  scan.sweep = start_ns / duration_ns;
  for (int column = 0; column < columns; ++column) {
    if (column > columns / 3 && column < columns / 2) continue;
    for (int ring = 0; ring < 4; ++ring) {
      const double share = (column + 0.1 * ring + 0.05) / columns;
      const double azimuth = std::numbers::pi - 2.0 * std::numbers::pi * share;
      const double elevation = 0.1 * ring - 0.2;
      LidarPoint point;
      point.position = (5.0 + ring + std::sin(azimuth)) * Eigen::Vector3d(std::cos(azimuth) * std::cos(elevation),
                                                                          std::sin(azimuth) * std::cos(elevation),
                                                                          std::sin(elevation))
                                                              .cast<float>();
      point.offset_ns = static_cast<std::int32_t>(share * static_cast<double>(duration_ns));
      point.ring = static_cast<std::uint16_t>(ring);
      point.intensity = static_cast<float>(ring) / 3.0F;
      scan.points.push_back(point);
    }
  }
  return scan;
}

/// 0.3 s of all sensors, in order of delivery, and the truth.
struct SyntheticSession {
  std::vector<SensorMessage> messages;
  std::vector<PoseTrack::Stamped> truth;
};

inline SyntheticSession synthetic_session() {
  SyntheticSession session;
  const auto add = [&](SensorPayload payload, std::int64_t delivery_ns) {
    session.messages.push_back({std::move(payload), delivery_ns, 0.0, {}});
  };
  for (std::int64_t step = 1; step <= 60; ++step) {
    const std::int64_t now_ns = 5'000'000 * step + 1;
    const double phase = 0.1 * static_cast<double>(step);
    add(ImuSample{now_ns, {std::sin(phase), 1.0 / 3.0, 0.0}, {0.1, std::cos(phase), 9.81}}, now_ns);
    session.truth.push_back(
        {now_ns, {rotation_from_rpy({0.01, 0.02, 0.3 * phase}), {phase, std::sin(phase), 1.0 / 3.0}}});
    if (step % 10 == 5) {
      for (const int camera : {kMainCamera, kRightCamera}) {
        CameraFrame frame{now_ns, camera, 16, 12, std::vector<std::uint8_t>(16 * 12)};
        for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
          frame.pixels[i] = static_cast<std::uint8_t>(i * static_cast<std::size_t>(step + camera));
        }
        add(frame, now_ns);
      }
      DepthFrame depth{now_ns, kDepthCamera, 16, 12, std::vector<float>(16 * 12, 0.0F)};
      for (std::size_t i = 1; i < depth.depth_m.size(); ++i) depth.depth_m[i] = 0.05F * static_cast<float>(i);
      add(depth, now_ns);
    }
    if (step % 20 == 0) add(synthetic_scan(now_ns - 100'000'000, 100'000'000, 30), now_ns);
  }
  return session;
}

/// All that a source has.
inline std::vector<SensorMessage> drained(const MessageSource& source) {
  std::vector<SensorMessage> messages;
  while (auto message = source()) messages.push_back(std::move(*message));
  return messages;
}

template <typename Payload>
std::vector<Payload> only(const std::vector<SensorMessage>& messages) {
  std::vector<Payload> found;
  for (const SensorMessage& message : messages) {
    if (const auto* payload = std::get_if<Payload>(&message.payload)) found.push_back(*payload);
  }
  return found;
}

}  // namespace plumbline
