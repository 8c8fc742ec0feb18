#pragma once

#include <sys/types.h>

/// What every process that we start has in common.
namespace plumbline {

constexpr int kCannotExecute = 127;  ///< exit code of a child that became no program, as of a shell's

/// For the child, between fork and exec, where only calls that are safe in a signal handler are allowed: a process
/// group of its own keeps the terminal's interrupt away, it dies with its parent, and leaves no core file.
void become_child_of(pid_t parent);

/// With whatever it started itself.
void kill_with_group(pid_t process);

}  // namespace plumbline
