#include "tools/commands/shared_options.h"

#include <algorithm>
#include <thread>

namespace plumbline {
namespace {
constexpr int kMaxThreads = 1024;
}  // namespace

CLI::Validator whole_number() {
  return CLI::Validator(
      [](const std::string& text) {
        const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
        return digits ? std::string() : "found '" + text + "'; allowed is a whole number from 0";
      },
      "WHOLE NUMBER");
}

void add_set_option(CLI::App& verb, std::vector<std::string>& overrides, const std::string& help) {
  verb.add_option("--set", overrides, help)->expected(1)->take_all()->allow_extra_args(false);
}

void add_threads_option(CLI::App& verb, int& threads) {
  verb.add_option("--threads", threads, "all of the machine by default; the results are the same")
      ->check(CLI::Range(1, kMaxThreads));
}

int threads_of(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace plumbline
