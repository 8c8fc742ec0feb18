#pragma once

#include <string>
#include <vector>

#include "tools/evaluation/figures.h"
#include "tools/evaluation/verdict.h"
#include "tools/output/provenance.h"

namespace plumbline {

constexpr int kResultSchemaVersion = 1;

/// The text of result.json: figures at the top level, every number finite or null.
std::string result_json(const RunFigures& figures, const Verdict& verdict, const RunRecord& record,
                        const Provenance& provenance);

/// What `plumbline evaluate --json` writes: the trajectory's figures under the same keys.
std::string trajectory_json(const TrajectoryFigures& figures);

}  // namespace plumbline
