#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace plumbline {

/// One solve of a module: its least eigenvalue, and whether the truth calls its scan or image degenerate.
struct LabelledSolve {
  double least_eigenvalue = 0.0;
  bool degenerate = false;
};

/// Where a module's threshold on eigenvalues should be: at the mid-point (of the logarithm, eigenvalues range over
/// decades) of the margin between the well-determined and the degenerate solves. Thesis Fig. 7.4.
struct ModuleThreshold {
  std::string module;
  std::size_t degenerate = 0;  ///< solves
  std::size_t well = 0;
  std::optional<double> degenerate_to;  ///< 99th percentile of the degenerate solves' least eigenvalue
  std::optional<double> well_from;      ///< 1st percentile of the well-determined ones'
  std::optional<double> threshold;      ///< nothing without solves of both kinds

  /// Whether a margin is there at all.
  bool is_clear() const { return threshold && *degenerate_to < *well_from; }
};

ModuleThreshold calibrate_threshold(const std::string& module, const std::vector<LabelledSolve>& solves);

/// The solves of a run whose stamp has a label outside the grey zone.
/// @param run_directory  holds degeneracy.csv and truth_degeneracy.csv; without either there are none
std::vector<LabelledSolve> labelled_solves(const std::filesystem::path& run_directory, const std::string& module);

/// The file that `calibrate` writes.
std::string thresholds_yaml(const std::string& sweep, const std::vector<ModuleThreshold>& thresholds);

}  // namespace plumbline
