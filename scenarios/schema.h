#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/config_reader.h"
#include "scenarios/scenario.h"

/// The keys of a scenario file, a function per section. Each leaves the default where the file says nothing; each
/// throws InputError.
namespace plumbline {

void read_world(ConfigReader& reader, WorldConfig& config);
void read_motion(ConfigReader& reader, MotionConfig& config);
/// @param seed  of what a rig draws once: its miscalibration
void read_rig(ConfigReader& reader, std::uint64_t seed, RigConfig& config);
/// @param directory  set with the name: what an outside estimator's files are relative to
void read_estimator(ConfigReader& reader, std::string& name, std::filesystem::path& directory, EstimatorConfig& config);
void read_expect(ConfigReader& reader, std::vector<Expectation>& expect, std::optional<std::string>& status);

}  // namespace plumbline
