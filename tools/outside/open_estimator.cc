#include "tools/outside/open_estimator.h"

#include <stdexcept>

#include "scenarios/calibration.h"
#include "scenarios/outside_name.h"
#include "tools/outside/outside_estimator.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// A library is hosted by this very program.
std::vector<std::string> command_of(const OutsideName& outside, const fs::path& directory) {
  if (outside.kind == OutsideName::Kind::kProgram) return outside.words;
  return {fs::read_symlink("/proc/self/exe").string(), "host", (directory / outside.words.front()).string()};
}

}  // namespace

std::unique_ptr<Estimator> open_estimator(const std::string& name, const fs::path& directory,
                                          const Calibration& calibration, const EstimatorConfig& config) {
  if (const auto outside = outside_name(name)) {
    if (!config.imu_enabled) throw InputError(name + ": an estimator from outside answers IMU samples; there are none");
    OutsideCommand command{name, command_of(*outside, directory), directory};
    command.is_host = outside->kind == OutsideName::Kind::kLibrary;
    return make_outside_estimator(command, calibration);
  }
  try {
    return make_estimator(name, calibration, config);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
}

std::unique_ptr<Estimator> open_estimator(const Scenario& scenario) {
  return open_estimator(scenario.estimator_name, scenario.estimator_directory, calibration_of(scenario),
                        scenario.estimator);
}

}  // namespace plumbline
