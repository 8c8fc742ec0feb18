#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "scenarios/recording.h"

/// Sources of messages from lists of files and samples, for readers of formats that keep a file per image. Each message
/// is delivered at its stamp; one whose stamp goes back, right behind the one before.
namespace plumbline {

struct StampedFile {
  std::filesystem::path path;
  std::int64_t stamp_ns = 0;
};

/// Files as messages, each read when it is asked for.
MessageSource file_source(std::vector<StampedFile> files, std::function<SensorPayload(const StampedFile&)> read);

/// Grey images as a camera's frames.
MessageSource frame_source(std::vector<StampedFile> images, int camera_id);

MessageSource imu_source(std::vector<ImuSample> samples);

/// Samples per second of their own span; 0 for fewer than two.
double rate_of(const std::vector<ImuSample>& samples);

}  // namespace plumbline
