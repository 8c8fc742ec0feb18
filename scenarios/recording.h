#pragma once

#include <cstdint>
#include <vector>

#include "estimator/geometry/interpolation.h"
#include "scenarios/sensor_link.h"

namespace plumbline {

/// Messages made earlier or elsewhere, with the truth about them where there is one.
struct Recording {
  MessageSource messages;                 ///< in order of delivery; made or read as they are asked for
  std::vector<PoseTrack::Stamped> truth;  ///< world_from_body in time order, empty where it is not known
  std::int64_t start_ns = 0;              ///< of the messages' time span
  std::int64_t end_ns = 0;                ///< an estimate will do: it serves the progress and the choice of snapshots
};

}  // namespace plumbline
