#include "tools/study/child_process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "tools/child_setup.h"

namespace plumbline {
namespace {

constexpr std::size_t kKeptOutput = 16'384;
constexpr double kMegabyte = 1e6;

[[noreturn]] void become(char* const* arguments, int output, pid_t parent, const rlimit& data) {
  become_child_of(parent);
  setrlimit(RLIMIT_DATA, &data);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execvp(arguments[0], arguments);
  static constexpr char kMessage[] = "the program cannot be executed\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  _exit(kCannotExecute);
}

/// The watch on resident memory looks in now and then; what is asked for all at once is refused at twice the limit.
/// Not RLIMIT_AS: shared libraries, thread stacks and the renderer reserve address space that they never touch.
rlimit data_limit(const RunLimits& limits) {
  const auto bytes = static_cast<rlim_t>(2.0 * limits.memory_mb * kMegabyte);
  return {bytes, bytes};
}

double resident_mb(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  double pages_total = 0.0;
  double pages_resident = 0.0;
  file >> pages_total >> pages_resident;
  return pages_resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / kMegabyte;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const RunLimits& limits) : limits_(limits) {
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error(std::string("no pipe for a run: ") + std::strerror(errno));
  }
  const pid_t parent = getpid();
  const rlimit data = data_limit(limits);
  process_ = fork();
  if (process_ == 0) become(arguments.data(), ends[1], parent, data);
  close(ends[1]);
  pipe_ = ends[0];
  if (process_ < 0) {
    const int reason = errno;
    close(pipe_);
    throw std::runtime_error(std::string("no process for a run: ") + std::strerror(reason));
  }
  fcntl(pipe_, F_SETFL, O_NONBLOCK);
}

ChildProcess::~ChildProcess() {
  if (process_ > 0) {
    kill_with_group(process_);
    waitpid(process_, nullptr, 0);
  }
  if (pipe_ >= 0) close(pipe_);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      limits_(other.limits_),
      start_(other.start_),
      output_(std::move(other.output_)),
      beyond_(other.beyond_) {}

std::optional<ChildEnd> ChildProcess::poll() {
  drain();
  int status = 0;
  rusage usage{};
  if (wait4(process_, &status, WNOHANG, &usage) == process_) {
    process_ = -1;
    drain();
    ChildEnd ended;
    ended.kind = beyond_.value_or(WIFSIGNALED(status) ? ChildEnd::Kind::kSignalled : ChildEnd::Kind::kExited);
    ended.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
    ended.output = std::move(output_);
    ended.wall_s = seconds_running();
    ended.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    ended.peak_memory_mb = static_cast<double>(usage.ru_maxrss) * 1024.0 / kMegabyte;
    return ended;
  }
  if (!beyond_ && seconds_running() > limits_.time_s) beyond_ = ChildEnd::Kind::kTimeLimit;
  if (!beyond_ && resident_mb(process_) > limits_.memory_mb) beyond_ = ChildEnd::Kind::kMemoryLimit;
  if (beyond_) kill_with_group(process_);
  return std::nullopt;
}

void ChildProcess::drain() {
  std::array<char, 4096> buffer{};
  for (ssize_t size = 0; (size = read(pipe_, buffer.data(), buffer.size())) > 0;) {
    output_.append(buffer.data(), static_cast<std::size_t>(size));
    if (output_.size() > 2 * kKeptOutput) output_.erase(0, output_.size() - kKeptOutput);
  }
}

double ChildProcess::seconds_running() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace plumbline
