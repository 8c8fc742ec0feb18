#include "estimator/lidar/sweep_assembler.h"

#include <algorithm>
#include <utility>

namespace plumbline {

std::optional<LidarScan> SweepAssembler::add(const LidarScan& part) {
  const bool continues = sweep_ && part.sweep == sweep_->sweep && part.stamp_ns >= sweep_->end_ns &&
                         part.end_ns - sweep_->stamp_ns <= kLongest_ns;
  if (!continues) {
    sweep_ = part;
  } else {
    const auto later_ns = static_cast<std::int32_t>(part.stamp_ns - sweep_->stamp_ns);
    sweep_->points.reserve(sweep_->points.size() + part.points.size());
    for (LidarPoint point : part.points) {
      point.offset_ns += later_ns;
      sweep_->points.push_back(point);
    }
    sweep_->end_ns = part.end_ns;
    sweep_->ends_sweep = part.ends_sweep;
  }
  if (!part.ends_sweep) return std::nullopt;
  return std::exchange(sweep_, std::nullopt);
}

std::int64_t newest_return_ns(const LidarScan& scan) {
  std::int32_t newest_ns = 0;
  for (const LidarPoint& point : scan.points) newest_ns = std::max(newest_ns, point.offset_ns);
  return std::min(scan.stamp_ns + newest_ns, scan.end_ns);
}

}  // namespace plumbline
