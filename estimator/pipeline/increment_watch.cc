#include "estimator/pipeline/increment_watch.h"

namespace plumbline {
namespace {

constexpr std::int64_t kIncrementWindow_ns = 1'000'000'000;

}  // namespace

void IncrementWatch::update(InertialFilter& filter, const PoseTrack& world_from_body) {
  const std::int64_t stamp_ns = filter.state().stamp_ns;
  revision_per_s_ = filter.map_revision() * filter.map_revision().transpose() / kRevisionMemory_s;
  if (stamp_ns <= past_ns_) return;
  const bool full = stamp_ns - past_ns_ >= kIncrementWindow_ns;
  if (!full && complete_) return;
  // Seen from the middle of the window: composing shares from its two ends would count the lever arms twice.
  const std::int64_t middle_ns = past_ns_ + (stamp_ns - past_ns_) / 2;
  const Matrix6d carry = adjoint(world_from_body.at(middle_ns).inverse() * filter.state().world_from_body);
  per_s_ = carry * filter.past_motion_covariance() * carry.transpose() / seconds_between(past_ns_, stamp_ns);
  if (!full) return;
  complete_ = true;
  filter.set_past();
  past_ns_ = stamp_ns;
}

}  // namespace plumbline
