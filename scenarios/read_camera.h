#pragma once

#include "scenarios/config_reader.h"
#include "scenarios/scenario.h"

namespace plumbline {

/// The sections rig.camera, rig.stereo, rig.depth_camera and rig.colour_camera. @throws InputError
void read_cameras(ConfigReader& rig, std::uint64_t seed, RigConfig& config);

/// The keys that a catalogue file and a scenario share: distortion [k1, k2, p1, p2] and shutter, global or rolling.
void read_lens_and_shutter(ConfigReader& reader, CameraModel& model);

}  // namespace plumbline
