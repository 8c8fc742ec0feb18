#pragma once

#include <string>
#include <vector>

#include "tools/verify/section.h"

namespace plumbline {

/// One HTML page that needs nothing but itself: a table of all rows, then each section with its charts.
std::string verify_page(const std::vector<VerifySection>& sections);

}  // namespace plumbline
