#pragma once

#include <stdexcept>

namespace plumbline {

/// Bad input: the message names the file, the key or line, what was found and what is allowed.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace plumbline
