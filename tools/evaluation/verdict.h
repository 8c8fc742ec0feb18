#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/evaluation/figures.h"

namespace plumbline {

enum class Status { kOk, kFailed, kLost, kError };
std::string to_string(Status status);

/// One bound of `expect:` held against its figure; a figure that is null holds no bound.
struct Check {
  Expectation expectation;
  std::optional<double> value;
  bool holds = false;
};

struct Verdict {
  Status status = Status::kOk;
  std::vector<Check> checks;
  std::optional<std::string> expected_status;
  bool holds = true;  ///< every bound, and the expected status

  /// 0 done, 1 a check did not hold, 3 a fault that nobody expected.
  int exit_code() const;
};

/// error (a fault), else lost (the estimator says so, or its error outgrew the distance), else failed (an `expect:`),
/// else ok. A run that was expected to be lost, and is, holds.
Verdict judge(const Scenario& scenario, const RunRecord& record, const RunFigures& figures);

/// "drift_percent = 0.72, expected at most 0.5"
std::string describe(const Check& check);

}  // namespace plumbline
