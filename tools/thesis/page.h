#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/thesis/results.h"

namespace plumbline {

/// Of a row's runs: label and address of the run's own page.
using RunLinks = std::map<std::string, std::vector<std::pair<std::string, std::string>>>;

/// The table of claims, and for each one begun its checks with a chart of the spread over seeds: one HTML page that
/// needs nothing but the runs' own pages that it links to.
std::string thesis_page(const std::vector<RowResult>& rows, const RunLinks& links);

}  // namespace plumbline
