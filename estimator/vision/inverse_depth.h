#pragma once

#include <limits>

namespace plumbline {

/// A feature's inverse depth 1/z along the optical axis of the view it is expressed in [1/m], as a Gaussian. Inverse
/// depth, because pixel noise is nearly Gaussian in it, and because infinity is the ordinary number 0.
struct InverseDepth {
  double mean = 0.0;
  double sigma = std::numeric_limits<double>::infinity();

  bool known() const { return mean > 0.0 && sigma < std::numeric_limits<double>::infinity(); }
};

}  // namespace plumbline
