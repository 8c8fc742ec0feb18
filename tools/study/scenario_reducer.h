#pragma once

#include <functional>
#include <vector>

#include "scenarios/config_node.h"

namespace plumbline {

/// Which of some scenarios still fail, in their order. Later answers may be missing once an earlier one is yes.
using StillFails = std::function<std::vector<bool>(const std::vector<ConfigNode>& candidates)>;

/// The simplest scenario that still fails, reached by steps that each still fail: fewer way-points
/// first, then without every key that is not needed, whole sections before their keys. The seed and the estimator's
/// name stay. One step after the other, however many candidates are asked for at a time.
/// @param keys  a scenario's keys, that fails
/// @param at_a_time  how many candidates still_fails is given
/// @param still_fails  an answer shorter than its question ends the search early
ConfigNode reduced(ConfigNode keys, std::size_t at_a_time, const StillFails& still_fails);

}  // namespace plumbline
