#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "estimator/estimator.h"
#include "scenarios/scenario.h"

namespace plumbline {

/// The estimator of that name: one of estimator_library(), a shared library or a program (scenarios/outside_name.h).
/// Both of the latter become processes of their own, so that whatever they do costs their run alone.
/// @param directory  in which an outside estimator is started
/// @throws InputError for a name that is none, a calibration or switches that the estimator cannot work with, or a
/// program that cannot be executed
std::unique_ptr<Estimator> open_estimator(const std::string& name, const std::filesystem::path& directory,
                                          const Calibration& calibration, const EstimatorConfig& config);

/// A scenario's estimator, told of the scenario's sensors.
std::unique_ptr<Estimator> open_estimator(const Scenario& scenario);

}  // namespace plumbline
