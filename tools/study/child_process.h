#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/sweep_file.h"

namespace plumbline {

/// How a child's life ended and what it took.
struct ChildEnd {
  enum class Kind { kExited, kSignalled, kTimeLimit, kMemoryLimit };
  Kind kind = Kind::kExited;
  int code = 0;        ///< exit code, or the signal
  std::string output;  ///< the last it wrote on standard output and standard error
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_memory_mb = 0.0;  ///< resident
};

/// A program running beside us, within limits. It dies with us, however we die, and does not see the terminal's
/// interrupts: those are for whoever started it to act on.
class ChildProcess {
 public:
  /// @param command  program and arguments
  /// @throws std::runtime_error if no process can be made
  ChildProcess(const std::vector<std::string>& command, const RunLimits& limits);
  /// Kills what still runs.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  /// Takes in what it wrote and ends it if it is beyond a limit. To be called often: memory is watched here.
  /// @returns its end, once
  std::optional<ChildEnd> poll();

 private:
  void drain();
  double seconds_running() const;

  pid_t process_ = -1;
  int pipe_ = -1;
  RunLimits limits_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::string output_;
  std::optional<ChildEnd::Kind> beyond_;  ///< the limit it was killed for
};

}  // namespace plumbline
