#include "tools/outside/outside_estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <map>

#include "scenarios/input_error.h"
#include "scenarios/recorder.h"
#include "tests/scenarios/temporary_directory.h"

namespace plumbline {
namespace {

using ::testing::HasSubstr;

/// Stands still, until the third IMU sample makes it do what its argument says.
constexpr const char* kFake = R"py(
import os, signal, struct, sys, time
how = sys.argv[1]
def read(size):
    data = sys.stdin.buffer.read(size)
    if len(data) != size:
        sys.exit("cut short")
    return data
def say(text):
    print(text, flush=True)
if how == "deaf":
    time.sleep(1000)
_, _, size = struct.unpack("<8sII", read(16))
read(size)
say({"greets wrong": "hello", "acknowledges": "plumbline-odometry 1 acknowledge"}.get(how, "plumbline-odometry 1"))
if how == "reads no more":
    time.sleep(1000)
samples = 0
while True:
    kind, size, _ = struct.unpack("<IIq", read(16))
    payload = read(size)
    if kind == 0:
        break
    if kind != 1:
        if how == "acknowledges":
            say("done")
        continue
    stamp = struct.unpack_from("<q", payload)[0]
    samples += 1
    pose = f"pose {stamp} {samples} 0 0 0 0 0 1"
    if samples == 3:
        if how == "crashes":
            os.kill(os.getpid(), signal.SIGSEGV)
        elif how == "exits":
            print("no more", file=sys.stderr, flush=True)
            sys.exit(5)
        elif how == "exits early":
            sys.exit(0)
        elif how == "hangs":
            time.sleep(1000)
        elif how == "leaves a child":
            if os.fork() == 0:
                time.sleep(1000)
            sys.exit(6)
        elif how == "garbage":
            sys.stdout.buffer.write(bytes(range(256)) + b"\n")
            sys.stdout.buffer.flush()
        elif how == "endless line":
            while True:
                sys.stdout.write("x" * 4096)
        elif how == "short":
            say("pose 1 2")
        elif how == "nan":
            say(f"pose {stamp} nan 0 0 0 0 0 1")
        elif how == "wrong stamp":
            say(f"pose {stamp + 1} 0 0 0 0 0 0 1")
        elif how == "declines":
            pose = "none"
        elif how == "answers twice":
            say(pose)
    say(pose)
if how == "ends badly":
    sys.exit(7)
if how == "never ends":
    time.sleep(1000)
print("used imu 2\ndropped imu 1 not liked\npoint 1 2 3 0.5", flush=True)
)py";

class OutsideEstimatorTest : public ::testing::Test {
 protected:
  OutsideEstimatorTest() { directory_.write("fake.py", kFake); }

  /// Drives it as a session does: five IMU samples, an image after each.
  RunRecord drive(const std::string& how, double silence_limit_s = 60.0, int image_side = 8) {
    const OutsideCommand command{"exec:mine",
                                 {PLUMBLINE_PYTHON, "fake.py", how},
                                 directory_.path(),
                                 false,
                                 std::chrono::duration<double>(silence_limit_s)};
    RunRecord record;
    {
      const auto estimator = make_outside_estimator(command, Calibration{});
      Recorder recorder(*estimator, 0, 5'000'000);
      for (int i = 1; i <= 5 && !recorder.faulted(); ++i) {
        recorder.deliver(ImuSample{i * 5'000'000, {}, {0.0, 0.0, 9.81}});
        const auto pixels = static_cast<std::size_t>(image_side) * static_cast<std::size_t>(image_side);
        recorder.deliver(CameraFrame{i * 5'000'000, 0, image_side, image_side, std::vector<std::uint8_t>(pixels)});
      }
      record = recorder.finish();
    }
    // No zombie: there is no child left to wait for.
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
    return record;
  }

  TemporaryDirectory directory_;
};

TEST_F(OutsideEstimatorTest, AnswersBecomeTheEstimate) {
  for (const std::string how : {"well", "acknowledges"}) {
    const RunRecord record = drive(how);
    EXPECT_EQ(record.fault, "");
    ASSERT_EQ(record.estimate.size(), 5U);
    EXPECT_EQ(record.estimate[4].stamp_ns, 25'000'000);
    EXPECT_EQ(record.estimate[4].pose.translation.x(), 5.0);
    EXPECT_EQ(record.messages.at(Module::kImu).used, 2) << "as it says itself";
    EXPECT_EQ(record.messages.at(Module::kImu).dropped.at("not liked"), 1);
    EXPECT_EQ(record.messages.at(Module::kVision).used, 5);
    ASSERT_EQ(record.map.size(), 1U);
    EXPECT_EQ(record.map[0].intensity, 0.5F);
  }
}

TEST_F(OutsideEstimatorTest, ASampleMayBeDeclined) {
  const RunRecord record = drive("declines");
  EXPECT_EQ(record.fault, "");
  EXPECT_EQ(record.estimate.size(), 4U);
}

TEST_F(OutsideEstimatorTest, ImagesLargerThanAnyPipePassBothWays) {
  // 16 MB an image; pipes hold 64 kB.
  const RunRecord record = drive("well", 60.0, 4096);
  EXPECT_EQ(record.fault, "");
  EXPECT_EQ(record.estimate.size(), 5U);
}

TEST_F(OutsideEstimatorTest, EveryMisdeedIsTheRunsFault) {
  const std::map<std::string, std::string> faults{
      {"crashes", "exec:mine, at the message stamped 0.015000000 s: killed by signal 11 (Segmentation fault)"},
      {"exits", "ended with exit code 5; its last words: no more"},
      {"exits early", "ended with exit code 0"},
      {"garbage", "wrote the line '"},
      {"endless line", "wrote a line of more than 65536 bytes"},
      {"short", "wrote the line 'pose 1 2': a field is missing"},
      {"nan", "found 'nan', expected a finite number"},
      {"wrong stamp", "answered with a pose stamped 15000001 ns to the sample stamped 15000000 ns"},
      {"answers twice", "answered with a pose stamped 15000000 ns to the sample stamped 20000000 ns"},
      {"greets wrong", "wrote 'hello', expected its first line to be 'plumbline-odometry 1'"},
      {"leaves a child", "ended with exit code 6"},
      {"ends badly", "after the message stamped 0.025000000 s: ended with exit code 7"},
  };
  for (const auto& [how, fault] : faults) {
    const RunRecord record = drive(how);
    EXPECT_THAT(record.fault, HasSubstr(fault)) << how;
    const std::size_t poses = how == "greets wrong" ? 0 : how == "ends badly" ? 5 : how == "answers twice" ? 3 : 2;
    EXPECT_EQ(record.estimate.size(), poses) << how << ": what was said before stays";
  }
}

TEST_F(OutsideEstimatorTest, SilenceIsAHang) {
  // On a busy machine the fake may not even have started by then, which is the same silence.
  for (const std::string how : {"deaf", "hangs", "never ends"}) {
    EXPECT_THAT(drive(how, 1.0).fault, HasSubstr("silent for 1.00 s")) << how;
  }
  // Never reads the image: the pipe is full for good.
  EXPECT_THAT(drive("reads no more", 1.0, 1024).fault, HasSubstr("silent for 1.00 s"));
}

TEST_F(OutsideEstimatorTest, WhatCannotBeExecutedIsBadInput) {
  const OutsideCommand command{"exec:./nothing", {"./nothing"}, directory_.path()};
  try {
    make_outside_estimator(command, Calibration{});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("./nothing: cannot be executed"));
  }
}

}  // namespace
}  // namespace plumbline
