#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline {

/// A program that we talk with: bytes go to its standard input, lines come from its standard output. What it writes on
/// standard error is passed on to ours. All of it is taken in at all times, so that full pipes never make both wait.
///
/// Every call but the constructor throws EstimatorFault: when the program has ended or closed its pipes, which the
/// message explains with its last words; when it keeps silent, takes nothing of what is sent or completes no line
/// within the limit; and when an interrupt has been asked for. The program dies with this object.
class OutsideProcess {
 public:
  /// @param command  program and arguments, not empty
  /// @param directory  in which it is started
  /// @throws InputError if it cannot be executed
  OutsideProcess(const std::vector<std::string>& command, const std::filesystem::path& directory,
                 std::chrono::duration<double> silence_limit);
  ~OutsideProcess();
  OutsideProcess(const OutsideProcess&) = delete;
  OutsideProcess& operator=(const OutsideProcess&) = delete;

  void send(std::string_view bytes);
  /// Its next line, without the end of line.
  std::string read_line();
  /// The same; nothing at the end of its standard output.
  std::optional<std::string> read_line_or_end();
  /// Tells it that nothing will follow.
  void close_input();
  /// Waits until it ends, which must be with exit code 0.
  void wait_for_end();

  /// Nothing while it runs, or if a signal ended it. Throws nothing.
  std::optional<int> exit_code() const;

 private:
  using Clock = std::chrono::steady_clock;

  void start(const std::vector<std::string>& command, const std::filesystem::path& directory);
  /// Waits a moment for it to take or give something, and does what can be done.
  void exchange(std::string_view& to_send);
  void write_some(std::string_view& to_send);
  bool read_output();
  void read_errors();
  std::optional<std::string> take_line();
  bool has_ended();
  [[noreturn]] void fail_ended();

  std::chrono::duration<double> silence_limit_;
  Clock::time_point heard_;  ///< when it last did what it was asked for, or was asked
  pid_t process_ = -1;
  int input_ = -1;
  int output_ = -1;
  int errors_ = -1;
  std::optional<int> status_;  ///< waitpid's, once it has ended
  std::string said_;           ///< on standard output
  std::size_t taken_ = 0;      ///< how much of it has been read
  std::string last_words_;     ///< on standard error
};

}  // namespace plumbline
