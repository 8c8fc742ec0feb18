#pragma once

#include <string>

namespace plumbline {

struct MountArguments {
  std::string study;
  std::string out;
  int jobs = 0;  ///< 0: as many as the machine has cores
  bool resume = false;
};

/// Predicts every mounting of a study, tries the promising ones with the estimator and recommends one. @returns the
/// exit code
int run_mount(const MountArguments& arguments);

}  // namespace plumbline
