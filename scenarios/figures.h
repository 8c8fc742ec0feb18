#pragma once

#include <string>
#include <vector>

namespace plumbline {

/// The figures of result.json that a scenario's `expect:` may bound: its top-level keys that are numbers.
const std::vector<std::string>& result_figures();

}  // namespace plumbline
