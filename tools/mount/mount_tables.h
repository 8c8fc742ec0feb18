#pragma once

#include <string>

#include "tools/mount/mount_results.h"

namespace plumbline {

/// predictions.csv: a column per free angle or offset, what stage one predicts, and the limit that is broken.
std::string predictions_csv(const MountStudy& study, const std::vector<Mounting>& mountings);

/// mountings.csv: the same, then runs, runs that were not ok, median drift with its interval, measured degenerate time,
/// cost, whether it is on the Pareto front and whether it is recommended.
std::string mountings_csv(const MountStudy& study, const MountResults& results);

/// Why the recommended mounting, in words.
std::string reason_for(const MountStudy& study, const MountResults& results);

}  // namespace plumbline
