#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "scenarios/session.h"
#include "tools/commands/command.h"
#include "tools/commands/map_options.h"
#include "tools/commands/shared_options.h"
#include "tools/exit_code.h"
#include "tools/formats/replay_config.h"
#include "tools/interrupt.h"
#include "tools/output/run_files.h"
#include "tools/output/summary.h"
#include "tools/outside/open_estimator.h"
#include "tools/progress_line.h"

namespace plumbline {
namespace {

struct ReplayArguments {
  std::string dataset;
  std::string format;
  std::string truth;
  std::string config;
  std::vector<std::string> overrides;
  std::string estimator;
  std::string out;
  MapArguments map;
  int threads = 0;
};

ReplayConfig config_of(const ReplayArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  if (!arguments.estimator.empty()) overrides.push_back("estimator.name=" + arguments.estimator);
  ReplayConfig config = read_replay_config(arguments.dataset, arguments.config, overrides);
  config.dataset.truth = arguments.truth;
  return config;
}

RunRecord drive(const Recording& recording, Estimator& estimator, const std::string& name, int threads) {
  ProgressLine line(name);
  SessionOptions options;
  options.threads = threads;
  options.progress = [&](double share) {
    line.update(share);
    return !interrupted();
  };
  return run_recording(recording, options, estimator);
}

int replay(const ReplayArguments& arguments) {
  ReplayConfig config = config_of(arguments);
  RunDirectory directory(arguments.out);
  const Dataset dataset = open_dataset(arguments.format, arguments.dataset, config.dataset);
  Scenario& scenario = config.scenario;
  if (!dataset.has_imu) scenario.estimator.imu_enabled = false;
  auto estimator =
      open_estimator(scenario.estimator_name, scenario.estimator_directory, dataset.calibration, scenario.estimator);
  if (const auto map = map_of(arguments.map)) {
    estimator = localize(std::move(estimator), *map, arguments.map, dataset.calibration, scenario.estimator);
  }
  const int threads = threads_of(arguments.threads);
  cv::setNumThreads(1);
  directory.open();
  catch_interrupts();
  RunRecord record = drive(dataset.recording, *estimator, scenario.name, threads);
  record.prior_map = arguments.map.map;
  const JudgedRun run = write_run(directory, scenario, record, nullptr, make_provenance(scenario, threads));

  std::cout << scenario.name << ", " << scenario.estimator_name << ": " << to_string(run.verdict.status) << "\n"
            << run_summary(record, run.figures, run.verdict) << "  report      "
            << (directory.target() / "report.html").string() << std::endl;
  return interrupted() ? kExitInterrupted : run.verdict.exit_code();
}

}  // namespace

void add_replay_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* verb = app.add_subcommand("replay", "Drive an estimator with a recorded dataset and judge what it said");
  verb->footer(replay_keys_help());
  verb->add_option("DATASET", arguments->dataset, "its folder or file")->required();
  verb->add_option("--format", arguments->format, "of the dataset")
      ->required()
      ->check(CLI::IsMember(dataset_formats()));
  verb->add_option("--truth", arguments->truth, "true poses from a file instead: TUM, EuRoC's .csv or KITTI's");
  verb->add_option("--config", arguments->config, "YAML file of what the dataset does not say of itself");
  add_set_option(*verb, arguments->overrides, "KEY=VALUE: sets one of the keys below");
  verb->add_option("--estimator", arguments->estimator, "see `plumbline list estimators`; vloam by default");
  verb->add_option("--out", arguments->out, "directory for the results")->required();
  add_map_options(*verb, arguments->map);
  add_threads_option(*verb, arguments->threads);
  verb->callback([arguments, &chosen] { chosen = [arguments] { return replay(*arguments); }; });
}

}  // namespace plumbline
