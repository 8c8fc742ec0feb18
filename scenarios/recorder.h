#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "scenarios/run_record.h"

namespace plumbline {

/// Hands messages to an estimator and keeps what comes of it. An estimator that throws is not called again; what it
/// threw becomes the record's fault.
class Recorder {
 public:
  /// Told what was tracked in the image that vision worked on last.
  using ImageListener = std::function<void(std::int64_t stamp_ns, const std::vector<TrackedFeature>&)>;

  /// The estimator must outlive the recorder.
  Recorder(Estimator& estimator, std::int64_t duration_ns, ImageListener on_image = {})
      : estimator_(estimator), duration_ns_(duration_ns), on_image_(std::move(on_image)) {}

  void deliver(const ImuSample& sample);
  void deliver(const CameraFrame& frame);
  void deliver(const DepthFrame& frame);
  void deliver(const LidarScan& scan);
  /// Counts a message that never arrived.
  void lose(const ImuSample&, const std::string& reason) { lose(Module::kImu, reason); }
  void lose(const CameraFrame&, const std::string& reason) { lose(Module::kVision, reason); }
  void lose(const DepthFrame&, const std::string& reason) { lose(Module::kVision, reason); }
  void lose(const LidarScan&, const std::string& reason) { lose(Module::kLidar, reason); }
  void add_truth(std::int64_t stamp_ns, const Pose& world_from_body);
  void add_sensors_wall(double wall_s) { record_.sensors_wall_s += wall_s; }

  /// Ends the run before its time.
  void set_fault(const std::string& fault) { record_.fault = fault; }

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
  std::int64_t duration_ns_ = 0;
  ImageListener on_image_;
  RunRecord record_;
};

}  // namespace plumbline
