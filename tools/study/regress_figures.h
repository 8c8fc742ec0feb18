#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/measured_run.h"

namespace plumbline {

/// A figure that a regression is judged by: positive, larger is worse, compared as a ratio.
struct RegressFigure {
  std::string key;
  std::string title;
  std::string unit;
  double effect_percent = 0.0;  ///< the least growth that may fail, unless the suite says otherwise
  double weight = 0.0;          ///< of its test over the whole suite in sharing out the rate of false alarms
  bool by_scenario = false;     ///< tested in each scenario as well
  bool of_machine = false;      ///< means nothing on another class of machine
  std::optional<double> (*value)(const MeasuredRun&) = nullptr;
};

/// The main one first.
const std::vector<RegressFigure>& regress_figures();

/// What a suite says instead of the figures' own effects, by their keys.
struct Effects {
  std::map<std::string, double> percent;

  double of(const RegressFigure& figure) const;
};

}  // namespace plumbline
