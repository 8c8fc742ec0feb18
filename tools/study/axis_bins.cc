#include "tools/study/axis_bins.h"

#include <algorithm>
#include <cmath>

#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

constexpr std::size_t kMostValues = 16;
constexpr std::size_t kStretches = 8;
constexpr std::size_t kLongestNumber = 6;

double place_of(const SweepAxis& axis, double value) { return axis.logarithmic ? std::log10(value) : value; }

std::pair<double, double> places_range(const SweepAxis& axis) {
  const double from = axis.range ? axis.range->first : *axis.values.front().number;
  const double to = axis.range ? axis.range->second : *axis.values.back().number;
  return {place_of(axis, from), place_of(axis, to)};
}

AxisBins stretches(const SweepPlan& plan, std::size_t index) {
  const SweepAxis& axis = plan.axes[index];
  const auto [from, to] = places_range(axis);
  const double width = (to - from) / kStretches;
  AxisBins bins{index, axis.key, true, {}, {}};
  for (std::size_t b = 0; b < kStretches; ++b) {
    const double middle = from + (static_cast<double>(b) + 0.5) * width;
    bins.bins.push_back({middle, readable_text(axis.logarithmic ? std::pow(10.0, middle) : middle)});
  }
  for (const PlannedRun& run : plan.runs) {
    const double at = (place_of(axis, *run.values[index].number) - from) / width;
    bins.bin_of_run.push_back(std::min(kStretches - 1, static_cast<std::size_t>(std::max(0.0, at))));
  }
  return bins;
}

}  // namespace

AxisBins bin_axis(const SweepPlan& plan, std::size_t index) {
  const SweepAxis& axis = plan.axes[index];
  if (axis.is_numeric() && (axis.is_sampled() || axis.values.size() > kMostValues)) return stretches(plan, index);
  AxisBins bins{index, axis.key, axis.is_numeric(), {}, {}};
  for (const AxisValue& value : axis.values) {
    const double place = bins.numeric ? place_of(axis, *value.number) : static_cast<double>(bins.bins.size());
    const bool is_long = bins.numeric && value.text.size() > kLongestNumber;
    bins.bins.push_back({place, is_long ? readable_text(*value.number) : value.text});
  }
  for (const PlannedRun& run : plan.runs) {
    const auto at = std::find_if(axis.values.begin(), axis.values.end(),
                                 [&](const AxisValue& value) { return value.text == run.values[index].text; });
    bins.bin_of_run.push_back(static_cast<std::size_t>(at - axis.values.begin()));
  }
  return bins;
}

}  // namespace plumbline
