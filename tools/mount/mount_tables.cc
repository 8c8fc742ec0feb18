#include "tools/mount/mount_tables.h"

#include <algorithm>

#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

constexpr int kMountDigits = 6;

std::string cell(double value) {
  std::string text = ",";
  append_general(text, value, kMountDigits);
  return text;
}

std::string head(const MountStudy& study) {
  std::string text;
  for (const SweepAxis& axis : study.runs.axes) text += axis.key + ",";
  return text +
         "predicted_drift_percent,predicted_worst_direction,predicted_degenerate_time,coverage,own_body_share,overlap,"
         "predicted_cost,ruled_out";
}

std::string prediction_cells(const Mounting& mounting) {
  std::string text;
  for (const AxisValue& value : mounting.values) text += (text.empty() ? "" : ",") + value.text;
  const MountPrediction& p = mounting.predicted;
  for (const double value : {p.drift_percent, p.worst_direction, p.degenerate_time, p.coverage, p.own_body_share,
                             p.overlap, mounting.predicted_cost}) {
    text += cell(value);
  }
  return text + "," + mounting.ruled_out;
}

std::string percent(double share) { return readable_text(100.0 * share) + " %"; }

std::string with_interval(const Interval& drift) {
  return readable_text(drift.value) + " % (" + readable_text(drift.low) + " … " + readable_text(drift.high) + ")";
}

}  // namespace

std::string predictions_csv(const MountStudy& study, const std::vector<Mounting>& mountings) {
  std::string text = head(study) + "\n";
  for (const Mounting& mounting : mountings) text += prediction_cells(mounting) + "\n";
  return text;
}

std::string mountings_csv(const MountStudy& study, const MountResults& results) {
  std::string text =
      head(study) +
      ",runs,not_ok,drift_percent,drift_low_percent,drift_high_percent,degenerate_time,cost,pareto_front,"
      "recommended\n";
  for (std::size_t i = 0; i < results.mountings.size(); ++i) {
    const Mounting& mounting = results.mountings[i];
    text += prediction_cells(mounting) + "," + std::to_string(mounting.runs) + "," + std::to_string(mounting.lost);
    if (mounting.drift_percent) {
      text += cell(mounting.drift_percent->value) + cell(mounting.drift_percent->low) +
              cell(mounting.drift_percent->high) + cell(mounting.degenerate_time) + cell(mounting.cost);
    } else {
      text += ",,,,,";
    }
    text += mounting.is_on_front ? ",1" : ",0";
    text += results.recommended == i ? ",1\n" : ",0\n";
  }
  return text;
}

std::string reason_for(const MountStudy& study, const MountResults& results) {
  if (!results.recommended) return "No mounting within the limits has been tried.";
  const Mounting& best = results.mountings[*results.recommended];
  std::size_t tried = 0;
  std::size_t drifts_less = 0;
  const Mounting* next = nullptr;
  for (const Mounting& other : results.mountings) {
    if (!other.tried) continue;
    ++tried;
    if (other.drift_percent->value < best.drift_percent->value) ++drifts_less;
    if (&other != &best && (next == nullptr || other.cost < next->cost)) next = &other;
  }
  std::string text = describe(study, best) + ": the least weighted cost of " + std::to_string(tried) +
                     " mountings tried. It drifts " + with_interval(*best.drift_percent) + ", ";
  text += drifts_less == 0 ? "the least of all; " : "more than " + std::to_string(drifts_less) + " of the others; ";
  text += "its scans leave a direction degenerate for " + percent(best.degenerate_time) +
          " of the time, the worst direction's bound is " + readable_text(best.predicted.worst_direction) +
          " of its limit (90th percentile), and it sees " + percent(best.predicted.coverage) +
          " of the surfaces about the path. The vehicle takes up " + percent(best.predicted.own_body_share) +
          " of the view; the lidar sees " + percent(best.predicted.overlap) + " of what the camera sees.";
  if (next != nullptr) {
    const bool apart = next->drift_percent->low > best.drift_percent->high;
    text += " Next comes " + describe(study, *next) + " with " + with_interval(*next->drift_percent) +
            (apart ? "." : ", whose interval overlaps: between the two, more seeds would have to decide.");
  }
  if (best.lost > 0) {
    text += " ";
    text += std::to_string(best.lost) + " of its " + std::to_string(best.runs) + " runs failed.";
  }
  return text;
}

}  // namespace plumbline
