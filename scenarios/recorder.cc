#include "scenarios/recorder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>

#include "scenarios/estimator_fault.h"

namespace plumbline {
namespace {

constexpr std::array<double, 3> kSnapshotShares{1.0 / 6.0, 1.0 / 2.0, 5.0 / 6.0};

Module module_of(const SensorPayload& payload) {
  if (std::holds_alternative<ImuSample>(payload)) return Module::kImu;
  return std::holds_alternative<LidarScan>(payload) ? Module::kLidar : Module::kVision;
}

}  // namespace

template <typename Call>
double Recorder::guarded(Call call) {
  const auto start = std::chrono::steady_clock::now();
  try {
    call();
  } catch (const EstimatorFault& fault) {
    set_fault(fault.what());
  } catch (const std::exception& error) {
    set_fault(std::string("the estimator threw: ") + error.what());
  } catch (...) {
    set_fault("the estimator threw something that is no std::exception");
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  record_.estimator_wall_s += wall.count();
  return wall.count();
}

template <typename Message>
void Recorder::add(Module module, std::int64_t stamp_ns, const Message& message) {
  if (faulted()) return;
  ++record_.messages[module].produced;
  const double wall_s = guarded([&] { estimator_.add(message); });
  record_.timing.push_back({stamp_ns, module, wall_s});
}

void Recorder::deliver(const SensorMessage& message) {
  record_.sensors_wall_s += message.wall_s;
  if (!message.lost.empty()) return lose(module_of(message.payload), message.lost);
  std::visit([this](const auto& payload) { deliver(payload); }, message.payload);
}

void Recorder::deliver(const ImuSample& sample) {
  add(Module::kImu, sample.stamp_ns, sample);
  take();
}

void Recorder::deliver(const CameraFrame& frame) {
  add(Module::kVision, frame.stamp_ns, frame);
  if (frame.camera_id == 0) take_snapshot(frame);
}

void Recorder::deliver(const DepthFrame& frame) { add(Module::kVision, frame.stamp_ns, frame); }

void Recorder::deliver(const LidarScan& scan) { add(Module::kLidar, scan.end_ns, scan); }

void Recorder::lose(Module module, const std::string& reason) {
  ++record_.messages[module].produced;
  ++record_.messages[module].dropped[reason];
}

void Recorder::add_truth(std::int64_t stamp_ns, const Pose& world_from_body) {
  record_.ground_truth.push_back({stamp_ns, world_from_body});
}

void Recorder::take() {
  if (faulted()) return;
  std::vector<Odometry> outputs;
  guarded([&] { outputs = estimator_.take(); });
  for (auto& output : outputs) {
    record_.health.insert(record_.health.end(), output.health.begin(), output.health.end());
    tell_of_image(output.health);
    output.health.clear();
    record_.map_matches.insert(record_.map_matches.end(), output.map_matches.begin(), output.map_matches.end());
    output.map_matches.clear();
    record_.estimate.push_back({output.stamp_ns, output.world_from_body});
    record_.estimator_lost = output.lost;
    record_.odometry.push_back(std::move(output));
  }
}

void Recorder::tell_of_image(const std::vector<ModuleHealth>& health) {
  const auto last = std::find_if(health.rbegin(), health.rend(),
                                 [](const ModuleHealth& row) { return row.module == Module::kVision; });
  if (!on_image_ || last == health.rend()) return;
  guarded([&] { on_image_(last->stamp_ns, estimator_.features()); });
}

void Recorder::take_snapshot(const CameraFrame& frame) {
  const std::size_t taken = record_.snapshots.size();
  if (faulted() || taken == kSnapshotShares.size()) return;
  const auto since_start = static_cast<double>(frame.stamp_ns - start_ns_);
  if (since_start < kSnapshotShares[taken] * static_cast<double>(end_ns_ - start_ns_)) return;
  FrameSnapshot snapshot{frame, {}};
  guarded([&] { snapshot.features = estimator_.features(); });
  record_.snapshots.push_back(std::move(snapshot));
}

RunRecord Recorder::finish() {
  guarded([&] {
    for (auto& [module, tally] : record_.messages) {
      const MessageCounts counts = estimator_.counts(module);
      tally.used = counts.used;
      for (const auto& [reason, count] : counts.dropped) tally.dropped[reason] += count;
    }
    record_.map = estimator_.map();
  });
  return std::move(record_);
}

}  // namespace plumbline
