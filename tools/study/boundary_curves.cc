#include "tools/study/boundary_curves.h"

#include <algorithm>
#include <cmath>

#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

std::string common_part(const SweepPlan& plan, const PlannedRun& run, std::size_t axis) {
  std::string text;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    if (a != axis) text += plan.axes[a].key + " = " + run.values[a].text + ", ";
  }
  return text + run.estimator;
}

const RunRow* find_row(const std::vector<RunRow>& rows, const std::string& key) {
  const auto found = std::lower_bound(
      rows.begin(), rows.end(), key, [](const RunRow& row, const std::string& wanted) { return row.run.key < wanted; });
  return found != rows.end() && found->run.key == key ? &*found : nullptr;
}

std::string curve_number(double value) {
  std::string text;
  append_general(text, value, 6);
  return text;
}

}  // namespace

double share_of_value(const SweepAxis& axis, double value) {
  const double first = *axis.values.front().number;
  const double last = *axis.values.back().number;
  return axis.logarithmic ? std::log(value / first) / std::log(last / first) : (value - first) / (last - first);
}

double value_of_share(const SweepAxis& axis, double share) {
  const double first = *axis.values.front().number;
  const double last = *axis.values.back().number;
  return axis.logarithmic ? first * std::pow(last / first, share) : first + share * (last - first);
}

std::vector<BoundaryCurve> boundary_curves(const SweepPlan& plan) {
  const std::size_t axis = plan.boundary().value();
  std::vector<double> positions;
  for (const AxisValue& value : plan.axes[axis].values) {
    positions.push_back(share_of_value(plan.axes[axis], *value.number));
  }
  std::vector<BoundaryCurve> curves;
  for (const PlannedRun& run : plan.runs) {
    const std::string label = common_part(plan, run, axis);
    auto curve = std::find_if(curves.begin(), curves.end(), [&](const BoundaryCurve& c) { return c.label == label; });
    if (curve == curves.end()) {
      curves.push_back({label, positions, std::vector<std::vector<std::string>>(positions.size())});
      curve = curves.end() - 1;
    }
    const auto& values = plan.axes[axis].values;
    const auto at = std::find_if(values.begin(), values.end(),
                                 [&](const AxisValue& value) { return *value.number == *run.values[axis].number; });
    curve->keys[static_cast<std::size_t>(at - values.begin())].push_back(run.key);
  }
  return curves;
}

ReplayedSearch replay(const BoundaryCurve& curve, const std::vector<RunRow>& rows) {
  ReplayedSearch replayed{BoundarySearch(curve.positions, curve.keys.front().size()), {}};
  for (;;) {
    const std::vector<Probe> batch = replayed.search.next_batch();
    for (const Probe& probe : batch) {
      const std::string& key = curve.keys[probe.position][probe.seed];
      if (find_row(rows, key) == nullptr) replayed.next.push_back(key);
    }
    // A batch is answered whole or not at all, so that what comes next never depends on which run ended first.
    if (batch.empty() || !replayed.next.empty()) return replayed;
    for (const Probe& probe : batch) {
      replayed.search.add(probe, find_row(rows, curve.keys[probe.position][probe.seed])->is_ok());
    }
  }
}

std::string boundary_csv(const SweepPlan& plan, const std::vector<RunRow>& rows) {
  const SweepAxis& axis = plan.axes[plan.boundary().value()];
  std::string text = "common,axis,boundary,low,high,probability_inside,probability_falling,runs,grid_runs\n";
  for (const BoundaryCurve& curve : boundary_curves(plan)) {
    const BoundarySearch search = replay(curve, rows).search;
    const BoundaryEstimate estimate = search.curve().boundary();
    text += "\"" + curve.label + "\"," + axis.key + "," + curve_number(value_of_share(axis, estimate.median)) + "," +
            curve_number(value_of_share(axis, estimate.low)) + "," + curve_number(value_of_share(axis, estimate.high)) +
            "," + fixed_text(estimate.probability_inside, 4) + "," + fixed_text(estimate.probability_falling, 4) + "," +
            std::to_string(search.made()) + "," + std::to_string(curve.positions.size() * curve.keys.front().size()) +
            "\n";
  }
  return text;
}

}  // namespace plumbline
