#pragma once

#include <functional>

#include "scenarios/run_record.h"
#include "scenarios/scenario.h"
#include "tools/evaluation/figures.h"
#include "tools/evaluation/verdict.h"
#include "tools/output/provenance.h"
#include "tools/output/run_directory.h"

namespace plumbline {

struct JudgedRun {
  RunFigures figures;
  Verdict verdict;
};

/// Evaluates and judges a run and puts its directory into place: ground_truth.tum, estimate.tum, map.ply,
/// degeneracy.csv, timing.csv, scenario.yaml, report.html and, last of all, result.json, whose real_time_factor thus
/// covers the others.
/// @param directory  open
/// @throws std::runtime_error if a file cannot be written; then nothing appears
JudgedRun write_run(RunDirectory& directory, const Scenario& scenario, const RunRecord& record,
                    const std::function<double(const Eigen::Vector3d&)>& distance_to_surface,
                    const Provenance& provenance);

}  // namespace plumbline
