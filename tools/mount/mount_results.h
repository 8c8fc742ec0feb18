#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/mount/mount_predictor.h"
#include "tools/mount/mount_study.h"
#include "tools/study/run_rows.h"
#include "tools/study/statistics.h"

namespace plumbline {

/// A mounting, what was predicted of it over all scenarios, and what the estimator made of it.
struct Mounting {
  std::vector<AxisValue> values;  ///< one per axis of the study
  MountPrediction predicted;      ///< drift: geometric mean over scenarios; of limits the worst; else the mean
  std::string ruled_out;          ///< which limit it breaks; empty: none
  bool tried = false;
  std::vector<double> drifts_percent;     ///< per seed, geometric mean over scenarios; lost runs count as 100 or more
  std::optional<Interval> drift_percent;  ///< their median
  std::map<std::string, Interval> drift_of_others;  ///< the same of the estimators that are not judged
  double degenerate_time = 0.0;                     ///< measured, of the scan matching's solves
  std::size_t runs = 0;
  std::size_t lost = 0;         ///< not ok
  double predicted_cost = 0.0;  ///< weighted sum of figures, each scaled from 0 (best) to 1 (worst) over the mountings
  double cost = 0.0;            ///< the same with the measured drift and degenerate time, of those tried
  bool is_on_front = false;     ///< no other is better in one figure and as good in all
};

struct MountResults {
  std::vector<Mounting> mountings;           ///< in the order of the plan
  std::optional<std::size_t> recommended;    ///< the least cost of those tried within the limits
  std::optional<Interval> rank_correlation;  ///< of predicted and measured drift
  std::optional<double> ceiling;             ///< what the measurement's own noise lets one expect of it
};

/// "rig.pitch_deg = 45, rig.z_m = 1.2"
std::string describe(const MountStudy& study, const Mounting& mounting);

/// Over scenarios. @param of_scenarios  the same mounting's, at least one
MountPrediction combined(const std::vector<MountPrediction>& of_scenarios);

/// The limit that is broken, in words; empty: none.
std::string broken_limit(const MountPrediction& prediction, const MountLimits& limits);

/// Sets the predicted costs and the front, and says which mountings the second stage should try.
std::vector<std::size_t> choose_for_trial(const MountStudy& study, std::vector<Mounting>& mountings);

/// Takes in the runs of the second stage, a list per scenario, and draws the conclusions.
MountResults conclude(const MountStudy& study, std::vector<Mounting> mountings,
                      const std::vector<std::vector<RunRow>>& rows_of_scenarios);

}  // namespace plumbline
