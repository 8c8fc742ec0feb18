#pragma once

#include <cstddef>
#include <vector>

namespace plumbline {

/// Where success turns into failure, in the axis's own share: 0 is its first value, 1 its last.
struct BoundaryEstimate {
  double median = 0.0;  ///< of the place where success and failure are equally likely
  double low = 0.0;     ///< 95 % credible interval
  double high = 0.0;
  double probability_inside = 0.0;   ///< that there is such a place between the first value and the last
  double probability_falling = 0.0;  ///< that success turns into failure with growing values, and not the reverse
};

/// One place of the fitted curve: its mean and 95 % credible interval.
struct CurvePoint {
  double position = 0.0;
  double mean = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// A logistic success curve and all that trials so far say about it: the posterior over a fixed grid of
///   P(success | u) = lapse + (1 - 2 lapse) / (1 + exp(±(u - m) / s)),
/// m uniform from a quarter before the axis to a quarter behind, s log-uniform from a step to a slope as wide as the
/// axis, both directions alike, few lapses more likely than many. The grid makes intervals and expected information
/// sums, without an optimiser that could fail on separable data.
/// Source: Kontsevich and Tyler, "Bayesian adaptive estimation of psychometric slope and threshold", Vision Res. 39
/// (1999); lapses as in Wichmann and Hill, Percept. Psychophys. 63 (2001).
class SuccessCurve {
 public:
  /// @param positions  where trials can be made, in [0, 1]
  explicit SuccessCurve(std::vector<double> positions);

  void add(std::size_t position, bool success);
  /// As if a trial had been made there whose outcome is as expected on average: what it would teach is spent.
  void suppose(std::size_t position);

  /// What a trial at each position is expected to tell about the boundary's place and direction, whatever slope and
  /// lapses are [nat]. Source: Prins, "The psi-marginal adaptive method", J. Vis. 13 (2013).
  std::vector<double> information() const;

  BoundaryEstimate boundary() const;
  /// At any places, not only those of trials.
  std::vector<CurvePoint> curve(const std::vector<double>& at) const;

 private:
  std::vector<double> weights() const;
  double probability(std::size_t cell, double position) const;

  std::vector<double> positions_;
  std::vector<double> success_;      ///< per position, per cell: its probability
  std::vector<double> log_weights_;  ///< per cell, up to a constant
};

}  // namespace plumbline
