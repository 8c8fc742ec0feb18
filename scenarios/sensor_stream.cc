#include "scenarios/sensor_stream.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <utility>

#include "scenarios/bounded_queue.h"
#include "sim/renderer.h"
#include "sim/rig_driver.h"

namespace plumbline {
namespace {

// A second of frames and scans: enough to even out the load, 16 MB at most.
constexpr std::size_t kMessagesAhead = 60;

RenderView view_of(const CameraModel& model) {
  const CameraIntrinsics intrinsics = intrinsics_of(model);
  RenderView view;
  view.width = intrinsics.width;
  view.height = intrinsics.height;
  view.fx = intrinsics.fx;
  view.fy = intrinsics.fy;
  view.cx = intrinsics.cx;
  view.cy = intrinsics.cy;
  return view;
}

std::unique_ptr<SensorMessage> timed(const std::function<std::variant<CameraFrame, LidarScan>()>& make,
                                     std::int64_t delivery_ns) {
  const auto start = std::chrono::steady_clock::now();
  auto message = std::make_unique<SensorMessage>();
  message->payload = make();
  message->delivery_ns = delivery_ns;
  message->wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return message;
}

/// The camera on the moving rig, at its next frame.
class FrameStream {
 public:
  FrameStream(const Scenario& scenario, const World& world, const Trajectory& world_from_body)
      : scenario_(scenario),
        end_ns_(world_from_body.end_ns()),
        driver_(world, world_from_body),
        renderer_(world, view_of(scenario.rig.camera), {.threads = 0, .depth = false}),
        camera_(scenario.rig.camera, scenario.seed),
        period_ns_(std::llround(1e9 / scenario.rig.camera.rate_hz)) {
    camera_.noise_enabled = scenario.rig.camera_noise;
  }

  std::unique_ptr<SensorMessage> next() {
    const std::int64_t stamp_ns = frame_ * period_ns_ + period_ns_ / 2;
    if (stamp_ns > end_ns_) return nullptr;
    auto message = timed([&] { return expose(stamp_ns); }, stamp_ns);
    frame_ += scenario_.rig.decimation;
    return message;
  }

 private:
  CameraFrame expose(std::int64_t stamp_ns) {
    driver_.advance_to(stamp_ns);
    const Pose world_from_camera = driver_.world_from_body().at(stamp_ns) * scenario_.rig.pack_from_camera;
    driver_.forget_before(stamp_ns);
    const double light = light_factor_at(scenario_.world.light_schedule, stamp_ns);
    return camera_.expose(renderer_.render(world_from_camera, light), stamp_ns, frame_);
  }

  const Scenario& scenario_;
  const std::int64_t end_ns_;
  RigDriver driver_;
  Renderer renderer_;
  Camera camera_;
  const std::int64_t period_ns_;
  std::int64_t frame_ = 0;  // index of the next one
};

/// The lidar on the moving rig, at its next scan.
class ScanStream {
 public:
  ScanStream(const Scenario& scenario, const World& world, const RayScene& rays, const Trajectory& world_from_body)
      : scenario_(scenario),
        world_(world),
        rays_(rays),
        end_ns_(world_from_body.end_ns()),
        driver_(world, world_from_body),
        lidar_(scenario.rig.lidar, scenario.rig.pack_from_lidar, scenario.seed) {
    lidar_.noise_enabled = scenario.rig.lidar_noise;
  }

  std::unique_ptr<SensorMessage> next() {
    const std::int64_t start_ns = scan_ * lidar_.period_ns();
    const std::int64_t end_ns = start_ns + lidar_.period_ns();
    if (end_ns > end_ns_) return nullptr;
    auto message = timed([&] { return cast(start_ns, end_ns); }, end_ns);
    scan_ += scenario_.rig.decimation;
    return message;
  }

 private:
  LidarScan cast(std::int64_t start_ns, std::int64_t end_ns) {
    driver_.advance_to(end_ns);
    LidarScan scan = lidar_.scan(rays_, world_, driver_.world_from_body(), start_ns, scan_);
    driver_.forget_before(end_ns);
    return scan;
  }

  const Scenario& scenario_;
  const World& world_;
  const RayScene& rays_;
  const std::int64_t end_ns_;
  RigDriver driver_;
  Lidar lidar_;
  std::int64_t scan_ = 0;  // index of the next one
};

/// Two sources as one, in order of delivery; the first goes first at one time.
class MergedSource {
 public:
  MergedSource(MessageSource first, MessageSource second)
      : first_(std::move(first)), second_(std::move(second)), next_first_(first_()), next_second_(second_()) {}

  std::unique_ptr<SensorMessage> next() {
    const bool take_first = next_first_ && (!next_second_ || next_first_->delivery_ns <= next_second_->delivery_ns);
    return take_first ? std::exchange(next_first_, first_())
                      : std::exchange(next_second_, next_second_ ? second_() : nullptr);
  }

 private:
  MessageSource first_;
  MessageSource second_;
  std::unique_ptr<SensorMessage> next_first_;
  std::unique_ptr<SensorMessage> next_second_;
};

template <typename Stream>
MessageSource source_of(std::shared_ptr<Stream> stream) {
  return [stream = std::move(stream)] { return stream->next(); };
}

/// Runs a stream in its own thread. Destruction stops the thread after the message it is at.
class ReadAhead {
 public:
  explicit ReadAhead(std::function<MessageSource()> make) : queue_(kMessagesAhead) {
    thread_ = std::thread([this, make = std::move(make)] { produce(make); });
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;
  ~ReadAhead() {
    queue_.abandon();
    thread_.join();
  }

  std::unique_ptr<SensorMessage> next() { return queue_.pop(); }

 private:
  void produce(const std::function<MessageSource()>& make) noexcept {
    try {
      const MessageSource source = make();
      while (auto message = source()) {
        if (!queue_.push(std::move(message))) return;
      }
      queue_.close();
    } catch (...) {
      queue_.close(std::current_exception());
    }
  }

  BoundedQueue<std::unique_ptr<SensorMessage>> queue_;
  std::thread thread_;
};

}  // namespace

double light_factor_at(const std::vector<LightStep>& schedule, std::int64_t stamp_ns) {
  double factor = 1.0;
  for (const auto& step : schedule) {
    if (step.start_s <= static_cast<double>(stamp_ns) * 1e-9) factor = step.factor;
  }
  return factor;
}

MessageSource make_source(const Scenario& scenario, const World& world, const RayScene& rays,
                          const Trajectory& world_from_body) {
  return source_of(
      std::make_shared<MergedSource>(source_of(std::make_shared<FrameStream>(scenario, world, world_from_body)),
                                     source_of(std::make_shared<ScanStream>(scenario, world, rays, world_from_body))));
}

MessageSource make_read_ahead_source(const Scenario& scenario, const World& world, const RayScene& rays,
                                     const Trajectory& world_from_body) {
  const auto frames = [&] { return source_of(std::make_shared<FrameStream>(scenario, world, world_from_body)); };
  const auto scans = [&] { return source_of(std::make_shared<ScanStream>(scenario, world, rays, world_from_body)); };
  return source_of(std::make_shared<MergedSource>(source_of(std::make_shared<ReadAhead>(frames)),
                                                  source_of(std::make_shared<ReadAhead>(scans))));
}

}  // namespace plumbline
