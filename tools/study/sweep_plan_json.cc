#include <nlohmann/json.hpp>

#include "tools/study/sweep_plan.h"

namespace plumbline {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const AxisValue& value) {
  if (value.number) return {{"text", value.text}, {"number", *value.number}};
  return {{"text", value.text}};
}

AxisValue value_of(const ordered_json& json) {
  AxisValue value{json.at("text"), std::nullopt};
  if (json.contains("number")) value.number = json["number"].get<double>();
  return value;
}

ordered_json json_of(const SweepAxis& axis) {
  ordered_json json{{"key", axis.key}, {"logarithmic", axis.logarithmic}, {"values", ordered_json::array()}};
  for (const AxisValue& value : axis.values) json["values"].push_back(json_of(value));
  if (axis.range) json["range"] = {axis.range->first, axis.range->second};
  return json;
}

SweepAxis axis_of(const ordered_json& json) {
  SweepAxis axis{json.at("key"), json.at("logarithmic"), {}, std::nullopt};
  for (const ordered_json& value : json.at("values")) axis.values.push_back(value_of(value));
  if (json.contains("range")) axis.range = {json["range"][0].get<double>(), json["range"][1].get<double>()};
  return axis;
}

std::string sample_name(SweepSample::Kind kind) {
  return kind == SweepSample::Kind::kSobol ? "sobol" : "latin_hypercube";
}

ordered_json json_of(const PlannedRun& run) {
  ordered_json json{{"key", run.key}, {"values", ordered_json::array()}};
  for (const AxisValue& value : run.values) json["values"].push_back(json_of(value));
  json["estimator"] = run.estimator;
  json["seed"] = run.seed;
  json["scenario_digest"] = run.scenario_digest;
  return json;
}

PlannedRun run_of(const ordered_json& json) {
  PlannedRun run{json.at("key"), {}, json.at("estimator"), json.at("seed"), json.at("scenario_digest")};
  for (const ordered_json& value : json.at("values")) run.values.push_back(value_of(value));
  return run;
}

}  // namespace

std::string plan_json(const SweepPlan& plan) {
  ordered_json json;
  json["name"] = plan.name;
  json["scenario"] = plan.scenario;
  json["set"] = plan.fixed;
  json["axes"] = ordered_json::array();
  for (const SweepAxis& axis : plan.axes) json["axes"].push_back(json_of(axis));
  json["sample"] = nullptr;
  if (plan.sample) json["sample"] = {{"kind", sample_name(plan.sample->kind)}, {"count", plan.sample->count}};
  json["estimators"] = plan.estimators;
  json["seeds"] = plan.seeds;
  json["limits"] = {{"time_s", plan.limits.time_s}, {"memory_mb", plan.limits.memory_mb}};
  json["find_boundary"] = plan.boundary_axis;
  if (!plan.detectors.empty()) json["detectors"] = plan.detectors;
  json["program"] = plan.program;
  json["runs"] = ordered_json::array();
  for (const PlannedRun& run : plan.runs) json["runs"].push_back(json_of(run));
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

SweepPlan plan_of_json(const std::string& text) {
  const ordered_json json = ordered_json::parse(text);
  SweepPlan plan;
  plan.name = json.at("name");
  plan.scenario = json.at("scenario");
  plan.fixed = json.at("set").get<std::vector<std::string>>();
  for (const ordered_json& axis : json.at("axes")) plan.axes.push_back(axis_of(axis));
  if (const ordered_json& sample = json.at("sample"); !sample.is_null()) {
    const bool is_sobol = sample.at("kind") == sample_name(SweepSample::Kind::kSobol);
    plan.sample = SweepSample{is_sobol ? SweepSample::Kind::kSobol : SweepSample::Kind::kLatinHypercube,
                              sample.at("count").get<std::size_t>()};
  }
  plan.estimators = json.at("estimators").get<std::vector<std::string>>();
  plan.seeds = json.at("seeds").get<std::vector<std::uint64_t>>();
  plan.limits = {json.at("limits").at("time_s"), json.at("limits").at("memory_mb")};
  plan.boundary_axis = json.at("find_boundary");
  plan.detectors = json.value("detectors", std::vector<std::string>{});
  plan.program = json.at("program");
  for (const ordered_json& run : json.at("runs")) plan.runs.push_back(run_of(run));
  return plan;
}

std::string plan_difference(const std::string& stored, const std::string& asked) {
  if (stored == asked) return {};
  const ordered_json before = ordered_json::parse(stored);
  const ordered_json now = ordered_json::parse(asked);
  for (const auto& [key, value] : now.items()) {
    if (before.contains(key) && before[key] == value) continue;
    if (key == "runs") return "the scenario itself (its resolved keys are others)";
    if (key == "axes") return "axes";
    return key + " (" + (before.contains(key) ? before[key].dump() : "nothing") + " there, " + value.dump() + " here)";
  }
  return "the plan";
}

}  // namespace plumbline
