#pragma once

#include <filesystem>

#include "tools/report/regression.h"

namespace plumbline {

/// Writes regress.html, its charts into charts/, and regress.md, each whole or not at all.
/// @param root  exists, with charts/ in it
/// @throws InputError if one cannot be written
void write_regress_outputs(const std::filesystem::path& root, const Regression& regression);

}  // namespace plumbline
