#pragma once

#include <string>
#include <vector>

#include "scenarios/run_record.h"

namespace plumbline {

/// degeneracy.csv: stamp_ns, module, mode, lambda_1 … 6 ascending, v_1_1 … v_6_6 (v_i_j: component j of eigenvector i,
/// [rotation; translation]), well_conditioned.
std::string degeneracy_csv(const std::vector<ModuleHealth>& health);

/// localization.csv: what each match with the prior map found.
std::string localization_csv(const std::vector<MapMatch>& matches);

/// timing.csv: stamp_ns, module, wall_ms of every message.
std::string timing_csv(const std::vector<TimingRow>& timing);

}  // namespace plumbline
