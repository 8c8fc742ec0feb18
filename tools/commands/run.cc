#include "tools/commands/run.h"

#include <tbb/global_control.h>

#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "scenarios/calibration.h"
#include "scenarios/degeneracy_lab.h"
#include "scenarios/session.h"
#include "tools/commands/command.h"
#include "tools/commands/shared_options.h"
#include "tools/commands/survey.h"
#include "tools/exit_code.h"
#include "tools/interrupt.h"
#include "tools/lab/lab_table.h"
#include "tools/output/run_files.h"
#include "tools/output/summary.h"
#include "tools/outside/open_estimator.h"
#include "tools/progress_line.h"

namespace plumbline {
namespace {

Scenario load(const RunArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  if (!arguments.estimator.empty()) overrides.push_back("estimator.name=" + arguments.estimator);
  return load_scenario(arguments.scenario, overrides, arguments.seed);
}

std::filesystem::path output_of(const RunArguments& arguments, const Scenario& scenario) {
  if (!arguments.out.empty()) return arguments.out;
  return std::filesystem::path("out") / (scenario.name + "-" + std::to_string(scenario.seed));
}

SessionOptions options_with(ProgressLine& line, int threads) {
  SessionOptions options;
  options.threads = threads;
  options.progress = [&line](double share) {
    line.update(share);
    return !interrupted();
  };
  return options;
}

/// What the run is localized on: the map asked for, or one that the scenario's survey makes first.
std::optional<SitedMap> prior_map(const RunArguments& arguments, const Scenario& scenario, const World& world,
                                  const RayScene& rays, int threads) {
  if (std::optional<SitedMap> map = map_of(arguments.map)) return map;
  if (!scenario.survey) return std::nullopt;
  const Scenario survey = survey_of(scenario);
  ProgressLine line(survey.name);
  return make_survey(survey, world, rays, options_with(line, threads));
}

/// A fault of ours ends the run, not its record: the directory says what happened.
/// @param images  gets what was tracked in each, if it is not null
RunRecord simulate(const RunArguments& arguments, const Scenario& scenario, const World& world, const RayScene& rays,
                   const std::optional<SitedMap>& map, int threads, std::vector<TrackedImage>* images) {
  ProgressLine line(scenario.name);
  SessionOptions options = options_with(line, threads);
  if (images != nullptr) {
    options.on_image = [images](std::int64_t stamp_ns, const std::vector<TrackedFeature>& features) {
      images->push_back({stamp_ns, {}});
      for (const TrackedFeature& feature : features) images->back().pixels.push_back(feature.pixel);
    };
  }
  try {
    auto estimator = open_estimator(scenario);
    if (map) {
      options.world_from_estimate = map->site_from_map;
      // The whole motion may have to be simulated for it.
      std::optional<Pose> start;
      if (arguments.map.start.empty() && map->site_from_map) start = world_from_imu_at_start(scenario, world, rays);
      estimator =
          localize(std::move(estimator), *map, arguments.map, calibration_of(scenario), scenario.estimator, start);
    }
    RunRecord record = run_session(scenario, world, rays, options, *estimator);
    record.prior_map = !map ? "" : !arguments.map.map.empty() ? arguments.map.map : scenario.survey->string();
    return record;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    RunRecord record;
    record.fault = error.what();
    return record;
  }
}

void judge_detectors(const Scenario& scenario, const World& world, const RayScene& rays,
                     const std::vector<TrackedImage>& images, const RunDirectory& directory) {
  ProgressLine line(scenario.name + ", detectors");
  const LabRun lab = run_degeneracy_lab(scenario, world, rays, [&](double share) {
    line.update(share);
    return !interrupted();
  });
  directory.write("detectors.csv", lab_csv(lab.scans));
  directory.write("mitigations.csv", mitigations_csv(lab));
  directory.write("truth_degeneracy.csv", truth_csv(lab.scans, label_images(scenario, world, rays, images)));
}

int exit_code_of(const Verdict& verdict) { return interrupted() ? kExitInterrupted : verdict.exit_code(); }

}  // namespace

int run_scenario(const RunArguments& arguments) {
  const Scenario scenario = load(arguments);
  RunDirectory directory(output_of(arguments, scenario));
  const int threads = threads_of(arguments.threads);
  // Also of what prepares the world: a run on one thread leaves the other cores to its neighbours.
  const tbb::global_control at_most(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const World world = make_world(scenario);
  const RayScene rays(world);
  // The session's threads are the run's parallelism; OpenCV's own pool would only crowd them.
  cv::setNumThreads(1);
  directory.open();
  catch_interrupts();
  std::vector<TrackedImage> images;
  const std::optional<SitedMap> map = prior_map(arguments, scenario, world, rays, threads);
  const RunRecord record =
      simulate(arguments, scenario, world, rays, map, threads, arguments.detectors ? &images : nullptr);
  if (arguments.detectors && !interrupted()) judge_detectors(scenario, world, rays, images, directory);
  const JudgedRun run = write_run(
      directory, scenario, record,
      [&](const Eigen::Vector3d& point) { return rays.distance_to_surface(point, kMapErrorLimit); },
      make_provenance(scenario, threads));

  std::cout << scenario.name << ", seed " << scenario.seed << ", " << scenario.estimator_name << ": "
            << to_string(run.verdict.status) << "\n"
            << run_summary(record, run.figures, run.verdict) << "  report      "
            << (directory.target() / "report.html").string() << std::endl;
  return exit_code_of(run.verdict);
}

void add_run_command(CLI::App& app, Action& chosen) {
  const auto arguments = std::make_shared<RunArguments>();
  CLI::App* run =
      app.add_subcommand("run", "Simulate a scenario, drive the estimator through it and judge what it said");
  run->add_option("SCENARIO", arguments->scenario, "scenario file")->required();
  add_set_option(*run, arguments->overrides, "KEY=VALUE: sets a key of the scenario, such as motion.speed_factor=2");
  run->add_option("--seed", arguments->seed, "instead of the scenario's")->check(whole_number());
  run->add_option("--estimator", arguments->estimator, "instead of the scenario's; see `plumbline list estimators`");
  run->add_option("--out", arguments->out, "directory for the results; out/NAME-SEED by default");
  run->add_flag("--detectors", arguments->detectors,
                "also judge detectors of degeneracy against the exact information, in detectors.csv");
  add_map_options(*run, arguments->map);
  add_threads_option(*run, arguments->threads);
  run->callback([arguments, &chosen] { chosen = [arguments] { return run_scenario(*arguments); }; });
}

}  // namespace plumbline
