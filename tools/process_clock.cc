#include "tools/process_clock.h"

#include <unistd.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace plumbline {
namespace {

// Where the kernel does not tell, the time of our own initialisation has to do.
const auto kInitialised = std::chrono::steady_clock::now();

/// Field 22 of /proc/self/stat: ticks from boot to the process's start. The second field may hold spaces, and
/// ends with the last ')'.
std::optional<double> start_after_boot_s() {
  std::ifstream file("/proc/self/stat");
  file.ignore(std::numeric_limits<std::streamsize>::max(), ')');
  constexpr int kFieldsBefore = 19;  // 3 … 21
  std::string skipped;
  for (int i = 0; i < kFieldsBefore; ++i) file >> skipped;
  double ticks = 0.0;
  if (!(file >> ticks)) return std::nullopt;
  return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace

double seconds_since_process_start() {
  const std::chrono::duration<double> since_initialised = std::chrono::steady_clock::now() - kInitialised;
  const auto start = start_after_boot_s();
  timespec now{};
  if (!start || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return since_initialised.count();
  const double since_start = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) - *start;
  // A container's clock may count from another boot than its /proc; loading never takes minutes.
  constexpr double kLongestLoading = 60.0;
  const bool plausible =
      since_start >= since_initialised.count() - 0.02 && since_start < since_initialised.count() + kLongestLoading;
  return plausible ? since_start : since_initialised.count();
}

}  // namespace plumbline
