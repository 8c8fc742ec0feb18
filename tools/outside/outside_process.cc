#include "tools/outside/outside_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include "scenarios/estimator_fault.h"
#include "scenarios/input_error.h"
#include "tools/child_setup.h"
#include "tools/formats/number_text.h"
#include "tools/interrupt.h"

namespace plumbline {
namespace {

constexpr std::size_t kLongestLine = 1 << 16;
constexpr std::size_t kMostUnasked = 1 << 24;  // that it may say while it is being sent something
constexpr std::size_t kKeptErrors = 4096;
constexpr int kLook_ms = 50;
constexpr std::chrono::seconds kEndingTime{10};  // from closing its pipes to its end

using Pipe = std::array<int, 2>;  // read end, write end

Pipe make_pipe() {
  Pipe ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw InputError(std::string("no pipe for an outside estimator: ") + std::strerror(errno));
  }
  return ends;
}

void close_and_forget(int& file) {
  if (file >= 0) close(file);
  file = -1;
}

/// @param failure  takes the reason if no program can be executed; closes when one is
[[noreturn]] void become(char* const* arguments, const char* directory, const std::array<int, 3>& standard,
                         pid_t parent, int failure) {
  become_child_of(parent);
  for (int i = 0; i < 3; ++i) dup2(standard[static_cast<std::size_t>(i)], i);
  if (chdir(directory) == 0) execvp(arguments[0], arguments);
  const int reason = errno;
  [[maybe_unused]] const ssize_t written = write(failure, &reason, sizeof reason);
  _exit(kCannotExecute);
}

/// write() that gives EPIPE in place of a signal, which would end us for a fault of the reader's.
ssize_t write_without_signal(int file, std::string_view bytes) {
  sigset_t pipe_signal;
  sigset_t before;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
  const ssize_t size = write(file, bytes.data(), bytes.size());
  const int reason = errno;
  if (size < 0 && reason == EPIPE) {
    const timespec at_once{};
    sigtimedwait(&pipe_signal, nullptr, &at_once);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = reason;
  return size;
}

bool would_block() { return errno == EAGAIN || errno == EINTR; }

std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of("\r\n ");
  if (end == std::string::npos) return {};
  const auto start = text.find_last_of('\n', end);
  return text.substr(start == std::string::npos ? 0 : start + 1, end - (start == std::string::npos ? -1 : start));
}

}  // namespace

OutsideProcess::OutsideProcess(const std::vector<std::string>& command, const std::filesystem::path& directory,
                               std::chrono::duration<double> silence_limit)
    : silence_limit_(silence_limit), heard_(Clock::now()) {
  start(command, directory);
  for (const int file : {input_, output_, errors_}) fcntl(file, F_SETFL, O_NONBLOCK);
}

void OutsideProcess::start(const std::vector<std::string>& command, const std::filesystem::path& directory) {
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Pipe input = make_pipe();
  Pipe output = make_pipe();
  Pipe errors = make_pipe();
  Pipe failure = make_pipe();
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) become(arguments.data(), directory.c_str(), {input[0], output[1], errors[1]}, parent, failure[1]);
  int reason = process_ < 0 ? errno : 0;
  for (int* file : {&input[0], &output[1], &errors[1], &failure[1]}) close_and_forget(*file);
  input_ = input[1];
  output_ = output[0];
  errors_ = errors[0];
  // Nothing to read: the pipe closed as the program took the child's place.
  if (process_ > 0 && read(failure[0], &reason, sizeof reason) <= 0) reason = 0;
  close_and_forget(failure[0]);
  if (reason == 0) return;
  for (int* file : {&input_, &output_, &errors_}) close_and_forget(*file);
  if (process_ > 0) waitpid(process_, nullptr, 0);
  throw InputError("exec:" + command.front() + ": cannot be executed in " + directory.string() + ": " +
                   std::strerror(reason));
}

OutsideProcess::~OutsideProcess() {
  if (!status_) {
    kill_with_group(process_);
    waitpid(process_, nullptr, 0);
  }
  for (int* file : {&input_, &output_, &errors_}) close_and_forget(*file);
}

void OutsideProcess::send(std::string_view bytes) {
  heard_ = Clock::now();
  while (!bytes.empty()) exchange(bytes);
}

std::string OutsideProcess::read_line() {
  auto line = read_line_or_end();
  if (!line) fail_ended();
  return *line;
}

std::optional<std::string> OutsideProcess::read_line_or_end() {
  heard_ = Clock::now();
  std::string_view nothing;
  for (;;) {
    if (auto line = take_line()) return line;
    if (output_ < 0) return std::nullopt;
    exchange(nothing);
  }
}

void OutsideProcess::close_input() { close_and_forget(input_); }

void OutsideProcess::wait_for_end() {
  heard_ = Clock::now();
  std::string_view nothing;
  while (!has_ended()) exchange(nothing);
  if (*status_ != 0) fail_ended();
}

std::optional<int> OutsideProcess::exit_code() const {
  return status_ && WIFEXITED(*status_) ? std::optional(WEXITSTATUS(*status_)) : std::nullopt;
}

void OutsideProcess::exchange(std::string_view& to_send) {
  if (interrupted()) throw EstimatorFault("interrupted");
  if (Clock::now() - heard_ > silence_limit_) {
    throw EstimatorFault("silent for " + readable_text(silence_limit_.count()) + " s, which is the limit");
  }
  std::array<pollfd, 3> files{pollfd{to_send.empty() ? -1 : input_, POLLOUT, 0}, pollfd{output_, POLLIN, 0},
                              pollfd{errors_, POLLIN, 0}};
  const int ready = poll(files.data(), files.size(), kLook_ms);
  // Something that it started may hold its pipes open after it has ended.
  if (ready == 0 && has_ended()) close_and_forget(output_);
  if (files[2].revents != 0) read_errors();
  if (files[1].revents != 0 && !read_output()) close_and_forget(output_);
  if (!to_send.empty() && output_ < 0) fail_ended();
  if (files[0].revents != 0) write_some(to_send);
  if (!to_send.empty() && said_.size() > kMostUnasked) {
    throw EstimatorFault("wrote " + std::to_string(said_.size()) + " bytes on standard output without being asked");
  }
}

void OutsideProcess::write_some(std::string_view& to_send) {
  const ssize_t size = write_without_signal(input_, to_send);
  if (size > 0) {
    to_send.remove_prefix(static_cast<std::size_t>(size));
    heard_ = Clock::now();
  } else if (size < 0 && !would_block()) {
    fail_ended();
  }
}

/// @returns false at its end
bool OutsideProcess::read_output() {
  std::array<char, 65'536> buffer;
  const ssize_t size = read(output_, buffer.data(), buffer.size());
  if (size > 0) said_.append(buffer.data(), static_cast<std::size_t>(size));
  return size > 0 || (size < 0 && would_block());
}

void OutsideProcess::read_errors() {
  std::array<char, 4096> buffer;
  const ssize_t size = read(errors_, buffer.data(), buffer.size());
  if (size > 0) {
    write_without_signal(STDERR_FILENO, {buffer.data(), static_cast<std::size_t>(size)});
    last_words_.append(buffer.data(), static_cast<std::size_t>(size));
    if (last_words_.size() > kKeptErrors) last_words_.erase(0, last_words_.size() - kKeptErrors);
  } else if (size == 0 || !would_block()) {
    close_and_forget(errors_);
  }
}

std::optional<std::string> OutsideProcess::take_line() {
  const auto end = said_.find('\n', taken_);
  if (std::min(end, said_.size()) - taken_ > kLongestLine) {
    throw EstimatorFault("wrote a line of more than " + std::to_string(kLongestLine) + " bytes");
  }
  if (end == std::string::npos) {
    said_.erase(0, std::exchange(taken_, 0));
    return std::nullopt;
  }
  std::string line = said_.substr(taken_, end - taken_);
  taken_ = end + 1;
  if (line.ends_with('\r')) line.pop_back();
  return line;
}

bool OutsideProcess::has_ended() {
  int status = 0;
  if (!status_ && waitpid(process_, &status, WNOHANG) == process_) status_ = status;
  return status_.has_value();
}

void OutsideProcess::fail_ended() {
  const auto closed = Clock::now();
  while (!has_ended() && Clock::now() - closed < kEndingTime) {
    if (errors_ >= 0) {
      pollfd file{errors_, POLLIN, 0};
      if (poll(&file, 1, kLook_ms) > 0) read_errors();
    } else {
      poll(nullptr, 0, kLook_ms);
    }
  }
  while (errors_ >= 0) {
    pollfd file{errors_, POLLIN, 0};
    if (poll(&file, 1, 0) <= 0) break;
    read_errors();
  }
  std::string what = "closed its standard input or output before its work was done";
  if (status_ && WIFSIGNALED(*status_)) {
    what = "killed by signal " + std::to_string(WTERMSIG(*status_)) + " (" + strsignal(WTERMSIG(*status_)) + ")";
  } else if (status_) {
    what = "ended with exit code " + std::to_string(*exit_code());
  }
  if (const std::string line = last_line(last_words_); !line.empty()) what += "; its last words: " + line;
  throw EstimatorFault(what);
}

}  // namespace plumbline
