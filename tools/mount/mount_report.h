#pragma once

#include <string>
#include <vector>

#include "tools/mount/mount_results.h"
#include "tools/report/drawing.h"

namespace plumbline {

/// A study's page, and its charts for files of their own.
struct MountReport {
  std::string html;
  std::vector<Drawing> charts;
};

/// @param views  what the recommended mounting sees, per scenario; empty while there is none
MountReport mount_report(const MountStudy& study, const MountResults& results, const std::vector<MountView>& views);

}  // namespace plumbline
