#pragma once

#include <string>

namespace plumbline {

struct RegressArguments {
  std::string suite;
  std::string baseline;
  bool update = false;  ///< rewrites the baseline instead of comparing with it
  std::string junit;    ///< file; empty: none
  std::string out;      ///< empty: out/SUITE
  int jobs = 0;         ///< 0: as many as the machine has cores
  std::string estimator;
};

/// Runs a suite and compares it with its baseline, or makes that anew. @returns the program's exit code
int run_regress(const RegressArguments& arguments);

}  // namespace plumbline
