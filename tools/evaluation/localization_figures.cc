#include "tools/evaluation/localization_figures.h"

#include <algorithm>
#include <vector>

#include "tools/evaluation/alignment.h"
#include "tools/evaluation/quantile.h"

namespace plumbline {
namespace {

constexpr std::int64_t kBlend_ns = 1'000'000'000;  // the first correction has been spent by then

template <typename Value>
std::vector<double> of_all(const std::vector<MapMatch>& matches, Value value) {
  std::vector<double> values;
  for (const MapMatch& match : matches) values.push_back(value(match));
  return values;
}

void add_matches(LocalizationFigures& figures, const std::vector<MapMatch>& matches, double duration_s) {
  figures.matches = static_cast<std::int64_t>(matches.size());
  double total_ms = 0.0;
  for (const MapMatch& match : matches) {
    ++figures.outcomes[std::string(to_string(match.agreement))];
    total_ms += 1e3 * match.processing_s;
  }
  figures.overlap_median = quantile(of_all(matches, [](const MapMatch& m) { return m.overlap; }), 0.5);
  figures.support_median = quantile(of_all(matches, [](const MapMatch& m) { return m.support; }), 0.5);
  figures.correction_median_m = quantile(of_all(matches, [](const MapMatch& m) { return m.correction_m; }), 0.5);
  figures.iterations_median =
      quantile(of_all(matches, [](const MapMatch& m) { return static_cast<double>(m.iterations); }), 0.5);
  if (!matches.empty()) figures.mean_ms = total_ms / static_cast<double>(matches.size());
  if (duration_s > 0.0) figures.ms_per_s = total_ms / duration_s;
}

void add_errors(LocalizationFigures& figures, const StampedPoses& truth, const StampedPoses& localized) {
  const std::vector<PosePair> pairs = pair_poses(truth, localized);
  if (pairs.empty()) return;
  const Alignment alignment = align(pairs, AlignmentKind::kSe3);
  std::vector<double> errors;
  for (const PosePair& pair : pairs) {
    errors.push_back((alignment.apply(pair.estimate).translation - pair.truth.translation).norm());
  }
  figures.error_median_m = quantile(errors, 0.5);
  figures.error_p75_m = quantile(errors, 0.75);
  figures.error_max_m = *std::max_element(errors.begin(), errors.end());
}

}  // namespace

std::optional<LocalizationFigures> localization_figures(const RunRecord& record) {
  if (record.prior_map.empty()) return std::nullopt;
  LocalizationFigures figures;
  StampedPoses localized;
  std::optional<std::int64_t> first_ns;
  std::size_t outputs = 0;
  for (const Odometry& output : record.odometry) {
    if (!output.localized) continue;
    ++outputs;
    if (!first_ns) first_ns = output.stamp_ns;
    if (output.stamp_ns >= *first_ns + kBlend_ns) localized.push_back({output.stamp_ns, output.world_from_body});
  }
  double duration_s = 0.0;
  if (!record.odometry.empty()) {
    const std::int64_t start_ns = record.odometry.front().stamp_ns;
    duration_s = seconds_between(start_ns, record.odometry.back().stamp_ns);
    figures.at_end = record.odometry.back().localized;
    figures.share = static_cast<double>(outputs) / static_cast<double>(record.odometry.size());
    if (first_ns) {
      figures.first_s = seconds_between(start_ns, *first_ns);
      figures.settled_ns = *first_ns + kBlend_ns;
    }
  }
  add_matches(figures, record.map_matches, duration_s);
  add_errors(figures, record.ground_truth, localized);
  return figures;
}

}  // namespace plumbline
