#include "tools/thesis/runs.h"

#include <cstdlib>

#include "scenarios/input_error.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

/// Of a rig with camera and lidar on one core.
constexpr double kUsualSecondsPerSimulatedSecond = 2.5;

const fs::path& made(const fs::path& root) {
  std::error_code error;
  fs::create_directories(root / "runs", error);
  if (error) throw InputError(root.string() + ": cannot be made: " + error.message());
  return root;
}

std::string cost_name(const Experiment& experiment) { return "cost_s/" + experiment.id; }

}  // namespace

ThesisRuns::ThesisRuns(const fs::path& root) : root_(made(root)), lock_(root_), store_(root_ / "thesis.sqlite") {
  for (StoredRun& run : store_.runs()) {
    // A time limit says more about the machine's other work than about the run: it gets another chance.
    if (run.outcome != "time_limit") runs_.emplace(run.key, std::move(run));
  }
}

std::vector<std::vector<std::optional<RunRow>>> ThesisRuns::of(const ThesisRow& row) const {
  std::vector<std::vector<std::optional<RunRow>>> rows(row.experiment.configurations.size());
  for (std::size_t c = 0; c < rows.size(); ++c) {
    rows[c].resize(row.experiment.seeds.size());
    for (std::size_t s = 0; s < row.runs[c].size(); ++s) {
      const auto found = runs_.find(row.runs[c][s].planned.key);
      if (found != runs_.end()) rows[c][s] = run_row(row.runs[c][s].planned, found->second);
    }
  }
  return rows;
}

std::vector<const ThesisRun*> ThesisRuns::missing(const ThesisRow& row) const {
  std::vector<const ThesisRun*> missing;
  for (std::size_t s = 0; s < row.experiment.seeds.size(); ++s) {
    for (const auto& of_configuration : row.runs) {
      if (s < of_configuration.size() && !has(of_configuration[s])) missing.push_back(&of_configuration[s]);
    }
  }
  return missing;
}

void ThesisRuns::add(const StoredRun& run) {
  store_.add(run);
  runs_.insert_or_assign(run.key, run);
}

double ThesisRuns::expected_s(const Experiment& experiment) const {
  const auto known = store_.property(cost_name(experiment));
  const double last_s = known ? std::strtod(known->c_str(), nullptr) : 0.0;
  return last_s > 0.0 ? last_s : kUsualSecondsPerSimulatedSecond * experiment.simulated_s;
}

void ThesisRuns::remember_cost(const Experiment& experiment, double wall_s) {
  store_.set_property(cost_name(experiment), std::to_string(wall_s));
}

}  // namespace plumbline
