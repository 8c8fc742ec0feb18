#include "tools/commands/merge.h"

#include <iostream>
#include <memory>

#include "tools/commands/command.h"
#include "tools/exit_code.h"
#include "tools/study/sweep_merge.h"
#include "tools/study/sweep_outputs.h"

namespace plumbline {

int merge_shards(const MergeArguments& arguments) {
  const MergedSweep merged =
      merge_sweeps({arguments.sources.begin(), arguments.sources.end()}, std::filesystem::path(arguments.out));
  write_sweep_outputs(arguments.out, merged.plan, merged.rows);
  std::cout << merged.plan.name << ": " << merged.rows.size() << " of " << merged.plan.runs.size() << " runs from "
            << arguments.sources.size() << " directories in " << arguments.out << std::endl;
  return kExitDone;
}

void add_merge_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<MergeArguments>();
  CLI::App* merge = app.add_subcommand("merge", "Bring the shards of a sweep together");
  merge->add_option("DIR", arguments->sources, "directories that the shards wrote")->required();
  merge->add_option("--out", arguments->out, "directory for the whole")->required();
  merge->callback([arguments, &chosen] { chosen = [arguments] { return merge_shards(*arguments); }; });
}

}  // namespace plumbline
