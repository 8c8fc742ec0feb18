// check_recordings: replays everything in a folder of recordings and tabulates it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "scenarios/input_error.h"
#include "tools/exit_code.h"
#include "tools/recordings/corner_tracks.h"
#include "tools/recordings/imu_start.h"
#include "tools/recordings/lidar_steps.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

struct Kind {
  bool (*is_there)(const fs::path&);
  CheckRows (*check)(const fs::path&);
};

/// What a folder is, is told by its files.
constexpr Kind kKinds[] = {
    {has_raw_steps, check_raw_steps},
    {has_odometry_pairs, check_odometry_pairs},
    {has_imu_and_truth, check_imu},
    {has_corner_tracks, check_corner_tracks},
};

std::vector<fs::path> folders_below(const fs::path& root) {
  std::error_code error;
  if (!fs::is_directory(root, error)) throw InputError(root.string() + ": no such folder");
  std::vector<fs::path> folders{root};
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

/// A recording that cannot be read is a row that does not hold, not the end of the others.
CheckRows check(const Kind& kind, const fs::path& folder) {
  try {
    return kind.check(folder);
  } catch (const InputError& error) {
    return {{folder.filename().string(), "reading", "", error.what(), false}};
  }
}

void print(const CheckRow& row) {
  const char* verdict = !row.holds ? "told   " : *row.holds ? "holds  " : "BROKEN ";
  std::cout << verdict << row.recording << ": " << row.check << ": " << row.measured
            << (row.bound.empty() ? "" : " (" + row.bound + ")") << std::endl;
}

ExitCode check_all(const fs::path& root) {
  ExitCode code = kExitDone;
  std::size_t checked = 0;
  for (const fs::path& folder : folders_below(root)) {
    for (const Kind& kind : kKinds) {
      if (!kind.is_there(folder)) continue;
      ++checked;
      for (const CheckRow& row : check(kind, folder)) {
        print(row);
        if (row.holds && !*row.holds) code = kExitCheckFailed;
      }
    }
  }
  if (checked == 0) throw InputError(root.string() + ": holds no recording of a known kind");
  return code;
}

}  // namespace
}  // namespace plumbline

int main(int argc, char** argv) {
  CLI::App app("Replays everything in a folder of recordings and tabulates what comes of it");
  std::string directory;
  app.add_option("DIR", directory, "unpacked recordings")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? plumbline::kExitDone : plumbline::kExitBadInput;
  }
  try {
    return plumbline::check_all(directory);
  } catch (const plumbline::InputError& error) {
    std::cerr << "check_recordings: " << error.what() << "\n";
    return plumbline::kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "check_recordings: " << error.what() << "\n";
    return plumbline::kExitFault;
  }
}
