#include "tools/lab/detector_scores.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/lidar/scan_matcher.h"
#include "tools/evaluation/quantile.h"

namespace plumbline {
namespace {

using Class = DegeneracyLabel::Class;

struct Scored {
  double score = 0.0;
  bool degenerate = false;
};

/// Between two neighbouring scores: geometric where both are positive, as scores range over decades.
double middle(double low, double high) { return low > 0.0 ? std::sqrt(low * high) : 0.5 * (low + high); }

/// Mann and Whitney's statistic: the chance that a degenerate scan scores below a well-determined one.
double area_under(const std::vector<Scored>& ascending, double degenerate, double well) {
  double wins = 0.0;
  double degenerate_below = 0.0;
  for (std::size_t i = 0; i < ascending.size();) {
    double tied_degenerate = 0.0;
    double tied_well = 0.0;
    std::size_t end = i;
    for (; end < ascending.size() && ascending[end].score == ascending[i].score; ++end) {
      (ascending[end].degenerate ? tied_degenerate : tied_well) += 1.0;
    }
    wins += tied_well * (degenerate_below + 0.5 * tied_degenerate);
    degenerate_below += tied_degenerate;
    i = end;
  }
  return wins / (degenerate * well);
}

/// A point in each gap between neighbouring scores, and the best of them.
void find_thresholds(const std::vector<Scored>& ascending, DetectorScore& result) {
  double hits = 0.0;
  double false_alarms = 0.0;
  double best = -1.0;
  ThresholdChoice choice;
  for (std::size_t i = 0; i + 1 < ascending.size(); ++i) {
    (ascending[i].degenerate ? hits : false_alarms) += 1.0;
    const double low = ascending[i].score;
    const double high = ascending[i + 1].score;
    if (low == high) continue;
    const RocPoint point{middle(low, high), false_alarms / static_cast<double>(result.well),
                         hits / static_cast<double>(result.degenerate)};
    result.roc.push_back(point);
    const double margin = low > 0.0 ? std::sqrt(high / low) : 1.0;
    const double gain = point.hits - point.false_alarms;
    if (gain > best || (gain == best && margin > choice.margin)) {
      best = gain;
      choice = {point, margin};
    }
  }
  if (best >= 0.0) result.choice = choice;
}

RocPoint at_threshold(double threshold, const std::vector<Scored>& scored, const DetectorScore& result) {
  double hits = 0.0;
  double false_alarms = 0.0;
  for (const Scored& scan : scored) {
    if (scan.score < threshold) (scan.degenerate ? hits : false_alarms) += 1.0;
  }
  return {threshold, false_alarms / static_cast<double>(result.well), hits / static_cast<double>(result.degenerate)};
}

/// How many scans of each stretch of degeneracy that begins within a run go by unreported.
void measure_latency(std::size_t detector, const std::vector<std::vector<LabRow>>& runs, DetectorScore& result) {
  if (!result.choice) return;
  std::vector<double> latencies;
  for (const std::vector<LabRow>& run : runs) {
    for (std::size_t i = 1; i < run.size(); ++i) {
      const auto is_degenerate = [&](std::size_t k) {
        return DegeneracyLabel::class_of(run[k].worst_excess) == Class::kDegenerate;
      };
      if (!is_degenerate(i) || is_degenerate(i - 1)) continue;
      std::size_t k = i;
      while (k < run.size() && is_degenerate(k) && run[k].scores[detector] >= result.choice->at.threshold) ++k;
      const bool reported = k < run.size() && is_degenerate(k);
      ++result.onsets;
      result.onsets_missed += reported ? 0 : 1;
      latencies.push_back(static_cast<double>(k - i));
    }
  }
  result.latency_scans = quantile(latencies, 0.5);
}

}  // namespace

DetectorScore score_detector(std::size_t detector, const std::vector<std::vector<LabRow>>& runs) {
  DetectorScore result;
  result.name = to_string(kDetectors[detector]);
  std::vector<Scored> scored;
  std::vector<double> angles;
  for (const std::vector<LabRow>& run : runs) {
    for (const LabRow& row : run) {
      const Class found = DegeneracyLabel::class_of(row.worst_excess);
      result.grey += found == Class::kGrey ? 1 : 0;
      if (found == Class::kGrey) continue;
      const bool degenerate = found == Class::kDegenerate;
      (degenerate ? result.degenerate : result.well) += 1;
      scored.push_back({row.scores[detector], degenerate});
      if (degenerate && row.angles_deg[detector]) angles.push_back(*row.angles_deg[detector]);
    }
  }
  std::stable_sort(scored.begin(), scored.end(), [](const Scored& a, const Scored& b) { return a.score < b.score; });
  if (result.degenerate > 0 && result.well > 0) {
    result.area = area_under(scored, static_cast<double>(result.degenerate), static_cast<double>(result.well));
    find_thresholds(scored, result);
    if (kDetectors[detector] == Detector::kD) {
      result.in_use = at_threshold(ScanMatcherConfig{}.degeneracy_threshold, scored, result);
    }
  }
  result.angle_deg = quantile(angles, 0.5);
  measure_latency(detector, runs, result);
  return result;
}

RegistrationEfficiency registration_efficiency(const std::vector<std::vector<LabRow>>& runs) {
  RegistrationEfficiency result;
  double selected = 0.0;
  double all = 0.0;
  for (const std::vector<LabRow>& run : runs) {
    for (const LabRow& row : run) {
      if (!row.error_over_selected || !row.error_over_all) continue;
      ++result.scans;
      selected += *row.error_over_selected;
      all += *row.error_over_all;
    }
  }
  if (result.scans == 0) return result;
  result.over_selected = std::sqrt(selected / static_cast<double>(result.scans));
  result.over_all = std::sqrt(all / static_cast<double>(result.scans));
  return result;
}

}  // namespace plumbline
