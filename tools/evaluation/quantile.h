#pragma once

#include <optional>
#include <vector>

namespace plumbline {

/// The value below which so large a share lies, linear between order statistics; nothing of an empty sample.
std::optional<double> quantile(std::vector<double> values, double share);

}  // namespace plumbline
