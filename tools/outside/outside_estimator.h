#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "estimator/estimator.h"

namespace plumbline {

/// How an outside estimator is started.
struct OutsideCommand {
  std::string name;                ///< as the user wrote it, for messages
  std::vector<std::string> words;  ///< program and arguments
  std::filesystem::path directory;
  bool is_host = false;  ///< of a library: the program's exit code 2, before anything else, says that it is none
  /// A program that takes this long over one message hangs. Not to be reached by one that is merely slow.
  std::chrono::duration<double> silence_limit{120.0};
};

/// An estimator that is a program of its own, in lock-step: it reads the message stream on its standard input and must
/// answer each IMU sample before the next message is sent (README.md beside this file).
///
/// Whatever it does wrong is thrown as EstimatorFault by the call that finds it, once; from then on it is left alone.
/// @throws InputError if it cannot be executed, or hosts what is no library
std::unique_ptr<Estimator> make_outside_estimator(const OutsideCommand& command, const Calibration& calibration);

}  // namespace plumbline
