#include "tools/commands/survey.h"

#include <stdexcept>

#include "scenarios/input_error.h"
#include "sim/random_stream.h"
#include "tools/evaluation/alignment.h"
#include "tools/evaluation/pairing.h"
#include "tools/outside/open_estimator.h"

namespace plumbline {

Scenario survey_of(const Scenario& scenario) {
  Scenario survey = load_scenario(*scenario.survey, {}, derive_seed(scenario.seed, "survey"));
  survey.world = scenario.world;
  if (survey.survey || survey.motion.closed_loop.enabled) {
    throw InputError(scenario.survey->string() + ": a survey is neither localized nor flown in closed loop");
  }
  return survey;
}

SitedMap make_survey(const Scenario& survey, const World& world, const RayScene& rays, const SessionOptions& options) {
  const auto estimator = open_estimator(survey);
  const RunRecord record = run_session(survey, world, rays, options, *estimator);
  const std::vector<PosePair> pairs = pair_poses(record.ground_truth, record.estimate);
  if (record.map.empty() || pairs.empty()) {
    throw InputError(survey.path.string() + ": as a survey it left no map" +
                     (record.fault.empty() ? "" : ": " + record.fault));
  }
  try {
    PriorMapBuilder builder(/*has_normals=*/true);
    for (const MapPoint& point : record.map) builder.add(point.position.cast<double>(), point.normal, point.intensity);
    return {builder.build(), place_on_site(pairs)};
  } catch (const std::invalid_argument& error) {
    throw InputError(survey.path.string() + ": as a survey: " + error.what());
  }
}

}  // namespace plumbline
