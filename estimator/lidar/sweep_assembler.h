#pragma once

#include <optional>

#include "estimator/messages.h"

namespace plumbline {

/// Joins the parts in which a scanner turned by a motor sends its sweep. A spinning lidar's scan is a whole sweep.
class SweepAssembler {
 public:
  /// Adds a part, and returns the sweep that it ends: stamped at its first part's start, with each return's own time
  /// and line. A sweep whose end never comes is let go when the next one starts; of one whose first parts are missing
  /// the rest is taken for the sweep. No sweep grows longer than kLongest_ns.
  std::optional<LidarScan> add(const LidarScan& part);

  static constexpr std::int64_t kLongest_ns = 2'000'000'000;  // offsets are 32 bits wide

 private:
  std::optional<LidarScan> sweep_;  ///< so far
};

/// The time up to which a scan has returns.
std::int64_t newest_return_ns(const LidarScan& scan);

}  // namespace plumbline
