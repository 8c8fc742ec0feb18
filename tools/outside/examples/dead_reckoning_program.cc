// An estimator as a program of its own: dead reckoning, after half a second at rest that shows gravity and the gyro's
// bias. It needs nothing of Plumbline's.
//
//     c++ -std=c++20 -O2 -I /usr/include/eigen3 -o mine dead_reckoning_program.cc
//
//     plumbline run scenarios/quickstart.yaml --estimator exec:./mine
//
// Messages come on standard input and answers go to standard output; tools/outside/README.md describes both.
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

struct RecordHead {
  std::uint32_t kind;
  std::uint32_t size;
  std::int64_t delivery_ns;
};
constexpr std::uint32_t kEnd = 0;
constexpr std::uint32_t kImu = 1;

struct Imu {
  std::int64_t stamp_ns;
  double rate[3];
  double force[3];
};

constexpr std::int64_t kRest_ns = 500'000'000;
const Eigen::Vector3d kGravity(0.0, 0.0, -9.81);

struct State {
  std::int64_t first_ns = 0;
  std::int64_t stamp_ns = 0;
  double samples = 0.0;
  Eigen::Vector3d force_sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_sum = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // world_from_body
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
};

void read_exactly(void* bytes, std::size_t size) {
  if (std::fread(bytes, 1, size, stdin) == size) return;
  std::fprintf(stderr, "the message stream was cut short\n");
  std::exit(1);
}

// At rest the specific force points up, and the gyro reads nothing but its bias. The estimate starts with yaw 0.
void rest(const Eigen::Vector3d& rate, const Eigen::Vector3d& force, State& state) {
  state.samples += 1.0;
  state.rate_sum += rate;
  state.force_sum += force;
  const Eigen::AngleAxisd roll(std::atan2(state.force_sum.y(), state.force_sum.z()), Eigen::Vector3d::UnitX());
  const Eigen::AngleAxisd pitch(-std::atan2(state.force_sum.x(), state.force_sum.tail<2>().norm()),
                                Eigen::Vector3d::UnitY());
  state.rotation = pitch * roll;
}

// The sample is the mean over the interval that ends at its stamp.
void move(const Eigen::Vector3d& rate, const Eigen::Vector3d& force, double dt, State& state) {
  const Eigen::Vector3d turn = (rate - state.rate_sum / state.samples) * dt;
  const Eigen::Quaterniond half(Eigen::AngleAxisd(0.5 * turn.norm(), turn.stableNormalized()));
  const Eigen::Vector3d acceleration = (state.rotation * half) * force + kGravity;
  state.position += (state.velocity + 0.5 * acceleration * dt) * dt;
  state.velocity += acceleration * dt;
  state.rotation = (state.rotation * half * half).normalized();
}

// @returns false for a sample that cannot be used
bool take(const Imu& imu, State& state) {
  const Eigen::Vector3d rate(imu.rate);
  const Eigen::Vector3d force(imu.force);
  const bool first = state.samples == 0.0;
  if (!rate.allFinite() || !force.allFinite() || (!first && imu.stamp_ns <= state.stamp_ns)) return false;
  if (first) state.first_ns = imu.stamp_ns;
  const double dt = 1e-9 * static_cast<double>(imu.stamp_ns - state.stamp_ns);
  state.stamp_ns = imu.stamp_ns;
  if (imu.stamp_ns - state.first_ns < kRest_ns) {
    rest(rate, force, state);
  } else {
    move(rate, force, dt, state);
  }
  return true;
}

void answer(const State& state) {
  const Eigen::Vector3d& p = state.position;
  const Eigen::Quaterniond& q = state.rotation;
  std::printf("pose %lld %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", static_cast<long long>(state.stamp_ns), p.x(),
              p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace

int main() {
  struct {
    char magic[8];
    std::uint32_t version;
    std::uint32_t calibration_size;
  } header;
  read_exactly(&header, sizeof header);
  if (std::string(header.magic, 8) != "PLUMBMSG" || header.version != 1) return 1;
  std::vector<char> payload(header.calibration_size);  // YAML; dead reckoning needs none of it
  read_exactly(payload.data(), payload.size());
  std::printf("plumbline-odometry 1\n");
  std::fflush(stdout);

  State state;
  for (RecordHead head;;) {
    read_exactly(&head, sizeof head);
    if (head.kind == kEnd) return 0;
    payload.resize(head.size);
    read_exactly(payload.data(), payload.size());
    if (head.kind != kImu) continue;  // camera, depth, lidar: not looked at
    Imu imu;
    std::memcpy(&imu, payload.data(), sizeof imu);
    if (take(imu, state)) {
      answer(state);
    } else {
      std::printf("none\n");
    }
    std::fflush(stdout);  // the next message comes only after the answer
  }
}
