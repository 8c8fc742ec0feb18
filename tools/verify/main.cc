// verify_sensors: holds the simulated sensors against their models and writes sensors.html.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "scenarios/input_error.h"
#include "tools/exit_code.h"
#include "tools/output/atomic_file.h"
#include "tools/verify/camera_section.h"
#include "tools/verify/imu_section.h"
#include "tools/verify/lidar_section.h"
#include "tools/verify/page.h"

namespace plumbline {
namespace {

ExitCode verify(const std::filesystem::path& directory) {
  const std::vector<VerifySection> sections{imu_section(), lidar_section(), camera_section()};
  ExitCode code = kExitDone;
  for (const VerifySection& section : sections) {
    for (const VerifyRow& row : section.rows) {
      std::cout << (row.holds ? "holds  " : "BROKEN ") << row.check << ": " << row.measured << " (" << row.bound
                << ")\n";
      if (!row.holds) code = kExitCheckFailed;
    }
  }
  std::filesystem::create_directories(directory);
  const std::filesystem::path page = directory / "sensors.html";
  write_file_atomically(page, verify_page(sections));
  std::cout << page.string() << "\n";
  return code;
}

}  // namespace
}  // namespace plumbline

int main(int argc, char** argv) {
  CLI::App app("Holds the simulated sensors against their models");
  std::string directory = "out/verify-sensors";
  app.add_option("--out", directory, "Where sensors.html goes");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? plumbline::kExitDone : plumbline::kExitBadInput;
  }
  try {
    return plumbline::verify(directory);
  } catch (const plumbline::InputError& error) {
    std::cerr << "verify_sensors: " << error.what() << "\n";
    return plumbline::kExitBadInput;
  } catch (const std::exception& error) {
    std::cerr << "verify_sensors: " << error.what() << "\n";
    return plumbline::kExitFault;
  }
}
