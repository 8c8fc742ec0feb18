#pragma once

#include "scenarios/session.h"
#include "tools/formats/point_cloud_file.h"

namespace plumbline {

/// The scenario's survey: what drives or walks, and with what sensors, in the scenario's own world and weather, with
/// noise of its own. @throws InputError also where the survey has a survey, or is a flight in closed loop
Scenario survey_of(const Scenario& scenario);

/// Runs a survey. Its map is laid on the site as surveyors do it, by points along the way whose places are known and by
/// the vertical: the one rigid transform that fits them best. @throws InputError if it leaves no map that can be used
SitedMap make_survey(const Scenario& survey, const World& world, const RayScene& rays, const SessionOptions& options);

}  // namespace plumbline
