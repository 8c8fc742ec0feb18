#pragma once

#include <stdexcept>

#include "scenarios/input_error.h"
#include "scenarios/scenario.h"

namespace plumbline {

/// Calls something whose complaints about its arguments are complaints about the scenario.
template <typename Call>
auto as_input(const Scenario& scenario, Call call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw InputError(scenario.path.string() + ": " + error.what());
  }
}

}  // namespace plumbline
