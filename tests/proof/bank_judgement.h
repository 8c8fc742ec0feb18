#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/study/measured_run.h"
#include "tools/study/suite_file.h"

/// Banks of a suite's runs over many seeds, by the estimator itself and by worsened ones: each a baseline file. The
/// regression gate is judged by regressions played with runs drawn from them.
namespace plumbline {

/// @param strength  of the degradation, 0: the estimator itself
std::string bank_name(double strength);
std::filesystem::path bank_file(const std::filesystem::path& directory, double strength);

/// Keeps of each bank the runs that all of them have.
void keep_common(std::vector<std::vector<MeasuredRun>>& banks);

/// How often the gate fails the estimator itself and catches the worsened ones, in words.
/// @param comparisons  of the estimator with itself; a quarter as many with each of the others
/// @throws InputError if a bank is missing or no baseline
std::string judged_banks(const std::filesystem::path& directory, const SuiteFile& suite,
                         const std::vector<double>& strengths, int comparisons);

}  // namespace plumbline
