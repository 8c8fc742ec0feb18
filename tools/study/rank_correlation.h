#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "tools/study/statistics.h"

namespace plumbline {

/// Spearman's rank correlation, ties sharing their mean rank.
/// @returns nothing for fewer than three pairs, or where all of one side are equal
std::optional<double> spearman(const std::vector<double>& x, const std::vector<double>& y);

/// The same with its percentile bootstrap interval over the pairs, 2000 resamples drawn from a stream of that name.
std::optional<Interval> bootstrap_spearman(const std::vector<double>& x, const std::vector<double>& y,
                                           std::string_view stream);

/// How well the things' medians over their samples reproduce: the rank correlation between the medians of two halves of
/// each thing's samples, averaged over 500 random halvings, then raised to the full number of samples by Spearman and
/// Brown's formula, 2 r / (1 + r). No prediction can be expected to rank the medians better.
/// @param samples  per thing, each at least two
/// @returns nothing for fewer than three things, or samples too few to halve
std::optional<double> split_half_ceiling(const std::vector<std::vector<double>>& samples, std::string_view stream);

}  // namespace plumbline
