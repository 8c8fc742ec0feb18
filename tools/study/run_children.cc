#include "tools/study/run_children.h"

#include <chrono>
#include <list>
#include <thread>

#include "tools/interrupt.h"

namespace plumbline {
namespace {

constexpr std::chrono::milliseconds kLookEvery{10};

struct Running {
  const ChildTask& task;
  ChildProcess process;
};

}  // namespace

bool run_children(const std::vector<ChildTask>& tasks, int jobs, const RunLimits& limits,
                  const std::function<void(const ChildTask&)>& starting,
                  const std::function<void(const ChildTask&, const ChildEnd&)>& ended) {
  std::list<Running> running;
  auto next = tasks.begin();
  while (next != tasks.end() || !running.empty()) {
    if (interrupted()) return false;
    while (next != tasks.end() && running.size() < static_cast<std::size_t>(jobs)) {
      starting(*next);
      running.push_back({*next, ChildProcess(next->command, limits)});
      ++next;
    }
    for (auto child = running.begin(); child != running.end();) {
      const auto end = child->process.poll();
      if (!end) {
        ++child;
        continue;
      }
      const ChildTask& task = child->task;
      child = running.erase(child);
      ended(task, *end);
    }
    std::this_thread::sleep_for(kLookEvery);
  }
  return true;
}

}  // namespace plumbline
