#pragma once

namespace plumbline {

/// What the program's exit code says, the same for every command.
enum ExitCode : int {
  kExitDone = 0,
  kExitCheckFailed = 1,  ///< an `expect:`, a regression
  kExitBadInput = 2,
  kExitFault = 3,  ///< ours
  kExitInterrupted = 130,
};

}  // namespace plumbline
