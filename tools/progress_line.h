#pragma once

#include <chrono>
#include <string>

namespace plumbline {

/// Progress of long work on standard error: a bar with the time left on a terminal, otherwise a plain line every 10 %.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  /// Clears the bar.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param share  done, [0, 1]
  void update(double share);

 private:
  void draw_bar(double share, double elapsed_s);
  void print_line(double share, double elapsed_s);

  std::string what_;
  bool terminal_;
  int tenths_printed_ = 0;
  double drawn_at_s_ = -1.0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace plumbline
