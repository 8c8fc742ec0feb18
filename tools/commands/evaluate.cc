#include "tools/commands/evaluate.h"

#include <iostream>
#include <memory>

#include "scenarios/scenario.h"
#include "tools/commands/command.h"
#include "tools/exit_code.h"
#include "tools/formats/tum.h"
#include "tools/output/atomic_file.h"
#include "tools/output/result_json.h"
#include "tools/output/summary.h"

namespace plumbline {

int evaluate_files(const EvaluateArguments& arguments) {
  const StampedPoses truth = read_tum(arguments.ground_truth);
  const StampedPoses estimate = read_tum(arguments.estimate);
  const TrajectoryFigures figures = trajectory_figures(truth, estimate, arguments.alignment);
  if (figures.aligned.empty()) {
    throw InputError(arguments.estimate + ": no stamp lies within 10 ms of " + arguments.ground_truth);
  }
  if (!arguments.json.empty()) write_file_atomically(arguments.json, trajectory_json(figures));
  std::cout << trajectory_summary(figures) << std::flush;
  return kExitDone;
}

void add_evaluate_command(CLI::App& app, Action& chosen) {
  struct Words {
    std::string format = "tum";
    std::string alignment;
  };
  const auto arguments = std::make_shared<EvaluateArguments>();
  const auto words = std::make_shared<Words>();
  CLI::App* evaluate = app.add_subcommand("evaluate", "Compare an estimated trajectory with the true one");
  evaluate->add_option("GROUND_TRUTH", arguments->ground_truth, "trajectory file")->required();
  evaluate->add_option("ESTIMATE", arguments->estimate, "trajectory file")->required();
  evaluate->add_option("--format", words->format, "of both files")
      ->check(CLI::IsMember({"tum"}))
      ->capture_default_str();
  evaluate
      ->add_option("--align", words->alignment,
                   "of every error; by default the first second for drift and progress, se3 for the absolute error")
      ->check(CLI::IsMember({"none", "origin", "yaw", "se3", "sim3"}));
  evaluate->add_option("--json", arguments->json, "writes the figures, under the keys of result.json");
  evaluate->callback([arguments, words, &chosen] {
    arguments->alignment = alignment_kind(words->alignment);
    chosen = [arguments] { return evaluate_files(*arguments); };
  });
}

}  // namespace plumbline
