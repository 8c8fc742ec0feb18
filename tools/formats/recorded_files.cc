#include "tools/formats/recorded_files.h"

#include <algorithm>
#include <utility>

#include "estimator/geometry/interpolation.h"
#include "tools/formats/image_file.h"

namespace plumbline {

MessageSource file_source(std::vector<StampedFile> files, std::function<SensorPayload(const StampedFile&)> read) {
  return [files = std::move(files), read = std::move(read), next = std::size_t{0},
          delivered_ns = INT64_MIN]() mutable -> std::unique_ptr<SensorMessage> {
    if (next == files.size()) return nullptr;
    const StampedFile& file = files[next++];
    delivered_ns = std::max(delivered_ns, file.stamp_ns);
    return timed_message([&] { return read(file); }, delivered_ns);
  };
}

MessageSource frame_source(std::vector<StampedFile> images, int camera_id) {
  return file_source(std::move(images), [camera_id](const StampedFile& image) {
    CameraFrame frame = read_grey_image(image.path);
    frame.stamp_ns = image.stamp_ns;
    frame.camera_id = camera_id;
    return frame;
  });
}

MessageSource imu_source(std::vector<ImuSample> samples) {
  return [samples = std::move(samples), next = std::size_t{0},
          delivered_ns = INT64_MIN]() mutable -> std::unique_ptr<SensorMessage> {
    if (next == samples.size()) return nullptr;
    const ImuSample& sample = samples[next++];
    delivered_ns = std::max(delivered_ns, sample.stamp_ns);
    return std::make_unique<SensorMessage>(SensorMessage{sample, delivered_ns, 0.0, {}});
  };
}

double rate_of(const std::vector<ImuSample>& samples) {
  if (samples.size() < 2 || samples.back().stamp_ns <= samples.front().stamp_ns) return 0.0;
  return static_cast<double>(samples.size() - 1) / seconds_between(samples.front().stamp_ns, samples.back().stamp_ns);
}

}  // namespace plumbline
