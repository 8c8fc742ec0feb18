#pragma once

#include <stdexcept>

namespace plumbline {

/// An estimator that cannot go on, with the whole reason: it becomes the run's fault as it stands.
class EstimatorFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace plumbline
