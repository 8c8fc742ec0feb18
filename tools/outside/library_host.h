#pragma once

#include <filesystem>

namespace plumbline {

/// The function that a shared library exports:
///     extern "C" plumbline::Estimator* plumbline_make_estimator(const char* calibration_yaml);
/// The estimator is ours to delete. Null, or an exception, says that none can be made.
constexpr const char* kMakeEstimatorSymbol = "plumbline_make_estimator";

/// Makes a shared library's estimator an outside program: reads the message stream on standard input, drives the
/// estimator, answers on standard output. What the library itself writes there goes to standard error.
/// @throws InputError for a file that is no such library; whatever the library throws
void host_library(const std::filesystem::path& library);

}  // namespace plumbline
