#include "tools/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace plumbline {
namespace {

constexpr int kBarWidth = 30;
constexpr double kRedrawEvery = 0.1;  // [s]

/// "1:05" from an hour down, "1:02:05" above.
std::string clock_text(double seconds) {
  const long whole = std::lround(std::clamp(seconds, 0.0, 359999.0));
  char text[32];
  if (whole < 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
  }
  return text;
}

std::string left_text(double share, double elapsed_s) {
  return share > 0.0 ? clock_text(elapsed_s * (1.0 - share) / share) + " left" : std::string();
}

}  // namespace

ProgressLine::ProgressLine(std::string what) : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::update(double share) {
  share = std::clamp(share, 0.0, 1.0);
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (terminal_) {
    draw_bar(share, elapsed_s);
  } else {
    print_line(share, elapsed_s);
  }
}

void ProgressLine::draw_bar(double share, double elapsed_s) {
  if (elapsed_s - drawn_at_s_ < kRedrawEvery && share < 1.0) return;
  drawn_at_s_ = elapsed_s;
  const int filled = static_cast<int>(share * kBarWidth);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
  std::fprintf(stderr, "\r\033[K%s [%s] %3.0f %%  %s", what_.c_str(), bar.c_str(), 100.0 * share,
               left_text(share, elapsed_s).c_str());
}

void ProgressLine::print_line(double share, double elapsed_s) {
  const int tenths = static_cast<int>(10.0 * share + 1e-9);
  if (tenths <= tenths_printed_) return;
  tenths_printed_ = tenths;
  std::fprintf(stderr, "%s: %d %% after %s, %s\n", what_.c_str(), 10 * tenths, clock_text(elapsed_s).c_str(),
               left_text(share, elapsed_s).c_str());
}

}  // namespace plumbline
