#include "scenarios/sensor_stream.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

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

/// The sensors on the moving rig, each at its next message.
class SensorStream {
 public:
  SensorStream(const Scenario& scenario, const World& world, const RayScene& rays, const Trajectory& world_from_body)
      : scenario_(scenario),
        world_(world),
        rays_(rays),
        end_ns_(world_from_body.end_ns()),
        driver_(world, world_from_body),
        renderer_(world, view_of(scenario.rig.camera)),
        camera_(scenario.rig.camera, scenario.seed),
        lidar_(scenario.rig.lidar, scenario.rig.pack_from_lidar, scenario.seed),
        frame_period_ns_(std::llround(1e9 / scenario.rig.camera.rate_hz)) {
    camera_.noise_enabled = scenario.rig.camera_noise;
    lidar_.noise_enabled = scenario.rig.lidar_noise;
  }

  std::unique_ptr<SensorMessage> next() {
    const bool frame_first = frame_ns() <= scan_end_ns();
    const std::int64_t delivery_ns = std::min(frame_ns(), scan_end_ns());
    if (delivery_ns > end_ns_) return nullptr;
    const auto start = std::chrono::steady_clock::now();
    auto message = std::make_unique<SensorMessage>();
    message->delivery_ns = delivery_ns;
    if (frame_first) {
      message->payload = make_frame();
      frame_ += scenario_.rig.decimation;
    } else {
      message->payload = make_scan();
      scan_ += scenario_.rig.decimation;
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    message->wall_s = wall.count();
    return message;
  }

 private:
  std::int64_t frame_ns() const { return frame_ * frame_period_ns_ + frame_period_ns_ / 2; }
  std::int64_t scan_start_ns() const { return scan_ * lidar_.period_ns(); }
  std::int64_t scan_end_ns() const { return scan_start_ns() + lidar_.period_ns(); }

  CameraFrame make_frame() {
    const std::int64_t stamp_ns = frame_ns();
    driver_.advance_to(stamp_ns);
    const Pose world_from_camera = driver_.world_from_body().at(stamp_ns) * scenario_.rig.pack_from_camera;
    const double light = light_factor_at(scenario_.world.light_schedule, stamp_ns);
    return camera_.expose(renderer_.render(world_from_camera, light), stamp_ns, frame_);
  }

  LidarScan make_scan() {
    driver_.advance_to(scan_end_ns());
    LidarScan scan = lidar_.scan(rays_, world_, driver_.world_from_body(), scan_start_ns(), scan_);
    // The next scan starts here at the earliest, and every frame up to here has been made.
    driver_.forget_before(scan_end_ns());
    return scan;
  }

  const Scenario& scenario_;
  const World& world_;
  const RayScene& rays_;
  const std::int64_t end_ns_;
  RigDriver driver_;
  Renderer renderer_;
  Camera camera_;
  Lidar lidar_;
  const std::int64_t frame_period_ns_;
  std::int64_t frame_ = 0;  // index of the next one
  std::int64_t scan_ = 0;
};

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
  const auto stream = std::make_shared<SensorStream>(scenario, world, rays, world_from_body);
  return [stream] { return stream->next(); };
}

MessageSource make_read_ahead_source(const Scenario& scenario, const World& world, const RayScene& rays,
                                     const Trajectory& world_from_body) {
  const auto ahead = std::make_shared<ReadAhead>([&] { return make_source(scenario, world, rays, world_from_body); });
  return [ahead] { return ahead->next(); };
}

}  // namespace plumbline
