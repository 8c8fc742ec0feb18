#include "tools/child_setup.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

namespace plumbline {

void become_child_of(pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kCannotExecute);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  std::signal(SIGINT, SIG_DFL);
}

void kill_with_group(pid_t process) {
  kill(-process, SIGKILL);
  kill(process, SIGKILL);  // the group does not exist yet in the child's first moment
}

}  // namespace plumbline
