#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/scenarios/temporary_directory.h"

namespace plumbline {

/// A second or two of a metre's way, with few images: most of a short run's time goes into those.
inline constexpr const char* kShortScenario =
    "world: {scene: conference_room}\n"
    "rig: {camera: {rate_hz: 5, width: 320, height: 180}}\n"
    "motion: {rest_s: 0.5, smoothing_s: 0.5, waypoints: [[0, 0, 1.5], [1, 0, 1.5]]}\n";

/// The program itself, called in a directory of its own; what it says goes to said.txt.
class ProgramFixture : public ::testing::Test {
 protected:
  /// @param variable  "PATH=..." for the program alone
  int call(const std::string& arguments, const std::string& variable = "") const {
    return exit_code_of(variable + " " PLUMBLINE_PROGRAM " " + arguments);
  }
  /// Interrupted as by Ctrl-C once a file or directory is there.
  int interrupted_call(const std::string& arguments, const std::string& once_there) const {
    return exit_code_of("{ " PLUMBLINE_PROGRAM " " + arguments + " & p=$!; while kill -0 $p && [ ! -e " + once_there +
                        " ]; do sleep 0.05; done; kill -INT $p; wait $p; }");
  }
  std::string content(const std::string& name) const {
    std::ifstream file(directory_.path() / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TemporaryDirectory directory_;

 private:
  int exit_code_of(const std::string& command) const {
    const std::string line = "cd '" + directory_.path().string() + "' && " + command + " >said.txt 2>&1";
    return WEXITSTATUS(std::system(line.c_str()));
  }
};

}  // namespace plumbline
