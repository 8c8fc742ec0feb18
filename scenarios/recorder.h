#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "scenarios/run_record.h"
#include "scenarios/sensor_message.h"

namespace plumbline {

/// Hands messages to an estimator and keeps what comes of it. An estimator that throws is not called again; what it
/// threw becomes the record's fault.
class Recorder {
 public:
  /// Told what was tracked in the image that vision worked on last.
  using ImageListener = std::function<void(std::int64_t stamp_ns, const std::vector<TrackedFeature>&)>;

  /// The estimator must outlive the recorder. @param start_ns, end_ns  the run's span
  Recorder(Estimator& estimator, std::int64_t start_ns, std::int64_t end_ns, ImageListener on_image = {})
      : estimator_(estimator), start_ns_(start_ns), end_ns_(end_ns), on_image_(std::move(on_image)) {}

  /// Hands a message over, or counts it if it was lost on the way.
  void deliver(const SensorMessage& message);
  void deliver(const ImuSample& sample);
  void deliver(const CameraFrame& frame);
  void deliver(const DepthFrame& frame);
  void deliver(const LidarScan& scan);
  void add_truth(std::int64_t stamp_ns, const Pose& world_from_body);

  /// Ends the run before its time.
  void set_fault(const std::string& fault) { record_.fault = fault; }

  /// All outputs so far.
  const std::vector<Odometry>& odometry() const { return record_.odometry; }
  bool faulted() const { return !record_.fault.empty(); }
  /// The record, completed by the estimator's counts and map. The recorder is used up.
  RunRecord finish();

 private:
  template <typename Message>
  void add(Module module, std::int64_t stamp_ns, const Message& message);
  void lose(Module module, const std::string& reason);
  void take();
  void tell_of_image(const std::vector<ModuleHealth>& health);
  void take_snapshot(const CameraFrame& frame);
  /// Calls the estimator; returns the wall time [s].
  template <typename Call>
  double guarded(Call call);

  Estimator& estimator_;
  std::int64_t start_ns_ = 0;
  std::int64_t end_ns_ = 0;
  ImageListener on_image_;
  RunRecord record_;
};

}  // namespace plumbline
