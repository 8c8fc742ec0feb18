#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace plumbline {

/// A figure with its 95 % interval.
struct Interval {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// A rate of successes with Wilson's score interval, which stays within [0, 1] and holds its level for few trials.
/// Source: Wilson, JASA 22 (1927); Brown, Cai and DasGupta, Statist. Sci. 16 (2001).
/// @param trials  more than zero
Interval wilson_interval(std::size_t successes, std::size_t trials);

/// The median with its percentile bootstrap interval, 2000 resamples drawn from a stream of that name.
/// @returns nothing of an empty sample; an interval of no width of a single value
std::optional<Interval> bootstrap_median(const std::vector<double>& values, std::string_view stream);

}  // namespace plumbline
