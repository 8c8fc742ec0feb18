#pragma once

namespace plumbline {

/// The value below which a chi-squared variable lies with a probability. Degrees of freedom may be any positive number.
/// @param probability  in (0, 1)
double chi_squared_quantile(double probability, double degrees_of_freedom);

}  // namespace plumbline
