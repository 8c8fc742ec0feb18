#include "tools/output/result_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace plumbline {
namespace {

using nlohmann::ordered_json;

ordered_json number(const std::optional<double>& value, bool is_count = false) {
  if (!value) return nullptr;
  if (is_count) return static_cast<std::int64_t>(*value);
  return *value;
}

/// Sets "a.b.c" in nested objects.
void set(ordered_json& object, const std::string& dotted_key, ordered_json value) {
  std::string pointer = "/" + dotted_key;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  object[ordered_json::json_pointer(pointer)] = std::move(value);
}

void set_all(ordered_json& object, const std::vector<Figure>& figures) {
  for (const Figure& figure : figures) set(object, figure.key, number(figure.value, figure.is_count));
}

ordered_json numbers(const std::vector<double>& values) {
  ordered_json list = ordered_json::array();
  for (const double value : values) list.push_back(std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr));
  return list;
}

void set_relative_by_second(ordered_json& result, const std::vector<RootMeanSquare>& seconds) {
  std::vector<double> m;
  std::vector<double> deg;
  for (const RootMeanSquare& second : seconds) {
    m.push_back(second.translation_m);
    deg.push_back(second.rotation_deg);
  }
  result["rpe_by_second_m"] = numbers(m);
  result["rpe_by_second_deg"] = numbers(deg);
}

ordered_json checks_json(const Verdict& verdict) {
  ordered_json checks = ordered_json::array();
  for (const Check& check : verdict.checks) {
    checks.push_back({{"key", check.expectation.key},
                      {"value", number(check.value)},
                      {"min", number(check.expectation.min)},
                      {"max", number(check.expectation.max)},
                      {"holds", check.holds}});
  }
  return checks;
}

ordered_json provenance_json(const Provenance& p) {
  return {{"version", p.version},
          {"git_commit", p.git_commit.empty() ? ordered_json(nullptr) : ordered_json(p.git_commit)},
          {"seed", p.seed},
          {"scenario", p.scenario},
          {"scenario_path", p.scenario_path},
          {"scenario_digest", p.scenario_digest},
          {"estimator", p.estimator},
          {"threads", p.threads},
          {"machine", {{"cpu", p.machine.cpu}, {"cores", p.machine.cores}, {"os", p.machine.os}}}};
}

void set_nested(ordered_json& result, const RunFigures& figures) {
  for (const Module module : kModules) {
    result["modules"][std::string(to_string(module))]["dof_histogram"] = figures.modules.at(module).dof_histogram;
    result["messages"][message_key(module)]["dropped"] = figures.messages.at(module).dropped;
  }
}

/// Names and paths may hold bytes that are no UTF-8; they must not cost a run its result.
std::string dump(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string result_json(const RunFigures& figures, const Verdict& verdict, const RunRecord& record,
                        const Provenance& provenance) {
  ordered_json result;
  result["schema_version"] = kResultSchemaVersion;
  result["status"] = to_string(verdict.status);
  result["fault"] = record.fault.empty() ? ordered_json(nullptr) : ordered_json(record.fault);
  result["scenario"] = provenance.scenario;
  result["seed"] = provenance.seed;
  result["estimator"] = provenance.estimator;
  set_all(result, figure_list(figures));
  result["kitti_scaled"] = figures.trajectory.kitti.scaled;
  set_relative_by_second(result, figures.trajectory.rpe_by_second);
  set_nested(result, figures);
  if (figures.flight) {
    result["flight_end"] = to_string(figures.flight->end);
    result["failure_origin"] = to_string(figures.flight->origin);
  }
  if (figures.localization) {
    result["localization"]["map"] = record.prior_map;
    result["localization"]["localized_at_end"] = figures.localization->at_end;
    result["localization"]["outcomes"] = figures.localization->outcomes;
  }
  result["expect_holds"] = verdict.holds;
  result["checks"] = checks_json(verdict);
  result["provenance"] = provenance_json(provenance);
  return dump(result);
}

std::string trajectory_json(const TrajectoryFigures& figures) {
  ordered_json result;
  result["schema_version"] = kResultSchemaVersion;
  set_all(result, figure_list(figures));
  result["kitti_scaled"] = figures.kitti.scaled;
  set_relative_by_second(result, figures.rpe_by_second);
  return dump(result);
}

}  // namespace plumbline
