#include "tools/interrupt.h"

#include <csignal>

namespace plumbline {
namespace {

volatile std::sig_atomic_t interrupt_seen = 0;

void remember_interrupt(int) { interrupt_seen = 1; }

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = remember_interrupt;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
}

bool interrupted() { return interrupt_seen != 0; }

}  // namespace plumbline
