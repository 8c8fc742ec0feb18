#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "scenarios/calibration.h"
#include "scenarios/session.h"
#include "tools/commands/command.h"
#include "tools/commands/shared_options.h"
#include "tools/exit_code.h"
#include "tools/formats/dataset.h"
#include "tools/formats/dataset_calibration.h"
#include "tools/interrupt.h"
#include "tools/output/run_directory.h"
#include "tools/progress_line.h"

namespace plumbline {
namespace {

struct ExportArguments {
  std::string scenario;
  std::string format;
  std::vector<std::string> overrides;
  std::optional<std::uint64_t> seed;
  std::string out;
  int threads = 0;
};

/// Messages that the simulation lost on their way are not there, as they would not be in a recording.
int export_scenario(const ExportArguments& arguments) {
  const Scenario scenario = load_scenario(arguments.scenario, arguments.overrides, arguments.seed);
  RunDirectory directory(arguments.out, kDatasetCalibration);
  const World world = make_world(scenario);
  const RayScene rays(world);
  cv::setNumThreads(1);
  directory.open();
  catch_interrupts();
  const auto writer = make_dataset_writer(arguments.format, directory.staging(), calibration_of(scenario));

  ProgressLine line(scenario.name);
  SessionOptions options;
  options.threads = threads_of(arguments.threads);
  options.progress = [&](double share) {
    line.update(share);
    return !interrupted();
  };
  std::vector<PoseTrack::Stamped> truth;
  const SessionListener listener{[&](std::int64_t stamp_ns, const Pose& world_from_body) {
                                   truth.push_back({stamp_ns, world_from_body});
                                 },
                                 [&](const SensorMessage& message) {
                                   if (message.lost.empty()) writer->write(message);
                                   return true;
                                 }};
  if (!simulate(scenario, world, rays, options, listener)) return kExitInterrupted;
  writer->finish(truth);
  directory.commit();
  std::cout << scenario.name << ", seed " << scenario.seed << ", as " << arguments.format << ": "
            << directory.target().string() << std::endl;
  return kExitDone;
}

}  // namespace

void add_export_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App* verb = app.add_subcommand("export", "Simulate a scenario and write its sensors' messages as a dataset");
  verb->add_option("SCENARIO", arguments->scenario, "scenario file")->required();
  verb->add_option("--format", arguments->format, "of the dataset")
      ->required()
      ->check(CLI::IsMember(dataset_formats()));
  add_set_option(*verb, arguments->overrides, "KEY=VALUE: sets a key of the scenario");
  verb->add_option("--seed", arguments->seed, "instead of the scenario's")->check(whole_number());
  verb->add_option("--out", arguments->out, "directory for the dataset")->required();
  add_threads_option(*verb, arguments->threads);
  verb->callback([arguments, &chosen] { chosen = [arguments] { return export_scenario(*arguments); }; });
}

}  // namespace plumbline
