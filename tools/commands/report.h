#pragma once

#include <string>

namespace plumbline {

/// Makes the page, charts and tables of a sweep's directory anew. @returns the exit code
int remake_report(const std::string& directory);

}  // namespace plumbline
