#include "tools/verify/chi_squared.h"

#include <cmath>

namespace plumbline {
namespace {

constexpr int kMaxTerms = 100'000;
constexpr double kPrecision = 1e-13;

/// Series of the lower incomplete gamma function, for x < a + 1 (Abramowitz and Stegun 6.5.29).
double lower_by_series(double a, double x) {
  double term = 1.0 / a;
  double sum = term;
  for (int n = 1; n < kMaxTerms && term > kPrecision * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// Continued fraction of the upper one, for x >= a + 1 (6.5.31), evaluated by Lentz's method.
double upper_by_fraction(double a, double x) {
  constexpr double kTiny = 1e-300;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double h = d;
  for (int n = 1; n < kMaxTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = 1.0 / (numerator * d + b);
    c = b + numerator / c;
    h *= c * d;
    if (std::abs(c * d - 1.0) < kPrecision) break;
  }
  return h * std::exp(a * std::log(x) - x - std::lgamma(a));
}

double chi_squared_probability(double value, double degrees_of_freedom) {
  const double a = 0.5 * degrees_of_freedom;
  const double x = 0.5 * value;
  if (x <= 0.0) return 0.0;
  return x < a + 1.0 ? lower_by_series(a, x) : 1.0 - upper_by_fraction(a, x);
}

}  // namespace

double chi_squared_quantile(double probability, double degrees_of_freedom) {
  double low = 0.0;
  double high = degrees_of_freedom + 1.0;
  while (chi_squared_probability(high, degrees_of_freedom) < probability) high *= 2.0;
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (chi_squared_probability(middle, degrees_of_freedom) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace plumbline
