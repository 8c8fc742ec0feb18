#pragma once

#include <string>

#include "scenarios/input_error.h"

namespace plumbline {

/// What an InputError said, or nothing if there was none.
template <typename Call>
std::string input_message_of(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace plumbline
