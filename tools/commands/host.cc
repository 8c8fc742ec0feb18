#include <memory>
#include <string>

#include "tools/commands/command.h"
#include "tools/exit_code.h"
#include "tools/outside/library_host.h"

namespace plumbline {

void add_host_command(CLI::App& app, Action& chosen) {
  const auto library = std::make_shared<std::string>();
  CLI::App* host = app.add_subcommand("host", "Drive a shared library's estimator: messages in, answers out");
  host->group("");  // not for people: what a run starts for --estimator LIBRARY.so
  host->add_option("LIBRARY", *library, "shared library")->required();
  host->callback([library, &chosen] {
    chosen = [library] {
      host_library(*library);
      return kExitDone;
    };
  });
}

}  // namespace plumbline
