#include "tools/study/sweep_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "estimator/solver/detectors.h"
#include "scenarios/yaml_reader.h"
#include "tools/formats/number_text.h"
#include "tools/study/sampling.h"

namespace plumbline {
namespace {

constexpr Range kAnyNumber{-1e12, 1e12};
constexpr Range kPositiveNumber{1e-12, 1e12};
constexpr Range kCount{2, 10'000};
constexpr Range kSampleCount{1, 100'000};
constexpr std::size_t kLeastBoundaryValues = 4;

std::optional<double> number_in(const ConfigNode& node) {
  if (!node.is_scalar() || node.quoted) return std::nullopt;
  double value = 0.0;
  const char* end = node.text.data() + node.text.size();
  const auto [stop, error] = std::from_chars(node.text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool before(const AxisValue& a, const AxisValue& b) {
  if (a.number && b.number) return *a.number < *b.number;
  return a.text < b.text;
}

std::vector<AxisValue> listed_values(const ConfigNode& node, const std::string& key) {
  if (node.items.empty()) fail_at(node, key, "at least one value");
  std::vector<AxisValue> values;
  for (const ConfigNode& item : node.items) values.push_back({flow_yaml(item), number_in(item)});
  std::sort(values.begin(), values.end(), before);
  const auto twice = std::adjacent_find(values.begin(), values.end(), [](const AxisValue& a, const AxisValue& b) {
    return a.number && b.number ? *a.number == *b.number : a.text == b.text;
  });
  if (twice != values.end()) fail_at(node, key, "each value once (" + twice->text + " stands there twice)");
  return values;
}

std::pair<double, double> bounds_of(const ConfigNode& node, const std::string& key, Range allowed) {
  if (!node.is_sequence() || node.items.size() != 2) fail_at(node, key, "two bounds [from, to]");
  const double from = number_of(node.items[0], key, allowed);
  const double to = number_of(node.items[1], key, allowed);
  if (!(from < to)) fail_at(node, key, "the smaller bound first");
  return {from, to};
}

std::vector<AxisValue> spread(const std::pair<double, double>& bounds, bool logarithmic, int count) {
  std::vector<AxisValue> values;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    values.push_back(rounded_value(logarithmic ? bounds.first * std::pow(bounds.second / bounds.first, share)
                                               : bounds.first + share * (bounds.second - bounds.first)));
  }
  return values;
}

std::vector<AxisValue> stepped(const ConfigNode& node, const std::string& key, const std::pair<double, double>& bounds,
                               double step) {
  const double steps = std::floor((bounds.second - bounds.first) / step + 1e-9);
  if (steps < 1.0 || steps >= kCount.max) fail_at(node, key, "a step that gives from 2 to 10000 values");
  std::vector<AxisValue> values;
  for (int i = 0; i <= static_cast<int>(steps); ++i) values.push_back(rounded_value(bounds.first + i * step));
  return values;
}

/// {range: [a, b], count | step} or {log_range: [a, b], count}.
void read_range(const ConfigNode& node, const std::string& path, bool sampled, SweepAxis& axis) {
  ConfigReader reader(node, path);
  const ConfigNode* linear = reader.find("range");
  const ConfigNode* logarithmic = reader.find("log_range");
  int count = 0;
  double step = 0.0;
  const bool has_count = reader.read("count", count, kCount);
  const bool has_step = reader.read("step", step, kPositiveNumber);
  reader.finish();
  if ((linear == nullptr) == (logarithmic == nullptr)) fail_at(node, path, "either range or log_range");
  axis.logarithmic = logarithmic != nullptr;
  const auto bounds = axis.logarithmic ? bounds_of(*logarithmic, path + ".log_range", kPositiveNumber)
                                       : bounds_of(*linear, path + ".range", kAnyNumber);
  if (sampled) {
    if (has_count || has_step) fail_at(node, path, "neither count nor step: `sample` says how many values there are");
    axis.range = bounds;
    return;
  }
  if (axis.logarithmic && has_step) fail_at(node, path, "a count: a logarithmic range has no step");
  if (has_count == has_step) fail_at(node, path, axis.logarithmic ? "a count" : "either count or step");
  axis.values = has_count ? spread(bounds, axis.logarithmic, count) : stepped(node, path + ".step", bounds, step);
}

SweepAxis read_axis(const std::string& path, const std::string& key, const ConfigNode& node, bool sampled) {
  if (key == "seed") fail_at(node, path, "seeds under `seeds`");
  if (key == "estimator.name") fail_at(node, path, "estimators under `estimators`");
  SweepAxis axis;
  axis.key = key;
  if (node.is_sequence()) {
    axis.values = listed_values(node, path);
  } else if (node.is_map()) {
    read_range(node, path, sampled, axis);
  } else {
    fail_at(node, path, "a list of values, {range: [a, b], count or step} or {log_range: [a, b], count}");
  }
  return axis;
}

void read_axes(ConfigReader& reader, const std::string& name, SweepFile& sweep) {
  const ConfigNode* axes = reader.find(name);
  if (axes == nullptr) return;
  if (!axes->is_map() || axes->entries.empty()) fail_at(*axes, name, "at least one KEY: values");
  for (const auto& [key, node] : axes->entries)
    sweep.axes.push_back(read_axis(name + "." + key, key, node, sweep.sample.has_value()));
  const auto is_sampled = [](const SweepAxis& axis) { return axis.is_sampled(); };
  const auto sampled = std::count_if(sweep.axes.begin(), sweep.axes.end(), is_sampled);
  if (sweep.sample && sampled == 0) fail_at(*axes, name, "a range for `sample` to draw from");
  if (sweep.sample && sweep.sample->kind == SweepSample::Kind::kSobol &&
      static_cast<std::size_t>(sampled) > kSobolDimensions) {
    fail_at(*axes, name, "at most " + std::to_string(kSobolDimensions) + " ranges for a Sobol sample");
  }
}

void read_sample(ConfigReader& reader, SweepFile& sweep) {
  reader.section("sample", [&](ConfigReader& sample) {
    int latin = 0;
    int sobol = 0;
    const bool is_latin = sample.read("latin_hypercube", latin, kSampleCount);
    const bool is_sobol = sample.read("sobol", sobol, kSampleCount);
    sample.finish();
    if (is_latin == is_sobol) fail_at(sample.node(), "sample", "either {latin_hypercube: N} or {sobol: N}");
    sweep.sample = SweepSample{is_latin ? SweepSample::Kind::kLatinHypercube : SweepSample::Kind::kSobol,
                               static_cast<std::size_t>(is_latin ? latin : sobol)};
  });
}

void read_estimators(ConfigReader& reader, SweepFile& sweep) {
  const ConfigNode* node = reader.find("estimators");
  if (node == nullptr) return;
  std::set<std::string> names;
  for (const ConfigNode& item : list_of(*node, "estimators")) {
    if (!names.insert(text_of(item, "estimators")).second) fail_at(item, "estimators", "each name once");
  }
  if (names.empty()) fail_at(*node, "estimators", "at least one name");
  sweep.estimators.assign(names.begin(), names.end());
}

/// An axis takes its own values.
void refuse_fixed_axes(ConfigReader& reader, const SweepFile& sweep) {
  const ConfigNode* node = reader.find("set");
  if (node == nullptr) return;
  for (const SweepAxis& axis : sweep.axes) {
    const auto found = node->entries.find(axis.key);
    if (found != node->entries.end()) fail_at(found->second, "set." + axis.key, "a key that is no axis");
  }
}

void read_boundary(ConfigReader& reader, SweepFile& sweep) {
  if (!reader.read("find_boundary", sweep.boundary_axis)) return;
  const ConfigNode& node = *reader.find("find_boundary");
  if (sweep.sample) fail_at(node, "find_boundary", "no `sample` beside it");
  const auto axis = std::find_if(sweep.axes.begin(), sweep.axes.end(),
                                 [&](const SweepAxis& candidate) { return candidate.key == sweep.boundary_axis; });
  if (axis == sweep.axes.end()) fail_at(node, "find_boundary", "the key of one of the axes");
  if (!axis->is_numeric() || axis->values.size() < kLeastBoundaryValues) {
    fail_at(node, "find_boundary", "an axis of at least " + std::to_string(kLeastBoundaryValues) + " numbers");
  }
}

void read_detectors(ConfigReader& reader, SweepFile& sweep) {
  const ConfigNode* node = reader.find("detectors");
  if (node == nullptr) return;
  std::vector<std::string> known;
  for (const Detector detector : kDetectors) known.emplace_back(to_string(detector));
  if (node->is_scalar() && node->text == "all") {
    sweep.detectors = known;
    return;
  }
  for (const ConfigNode& item : list_of(*node, "detectors")) {
    const std::string& name = text_of(item, "detectors");
    const bool is_known = std::find(known.begin(), known.end(), name) != known.end();
    if (!is_known) fail_at(item, "detectors", "one of " + joined(known) + ", or `all` in place of a list");
    sweep.detectors.push_back(name);
  }
}

}  // namespace

AxisValue rounded_value(double number) {
  constexpr int kDigits = 6;
  AxisValue value;
  append_general(value.text, number, kDigits);
  // What counts is the text, which is what the run is given.
  double shown = number;
  std::from_chars(value.text.data(), value.text.data() + value.text.size(), shown);
  value.number = shown;
  return value;
}

bool SweepAxis::is_numeric() const {
  return is_sampled() || std::all_of(values.begin(), values.end(), [](const AxisValue& v) { return v.number; });
}

void read_runs(ConfigReader& reader, SweepFile& sweep, const std::string& axes) {
  read_sample(reader, sweep);
  read_axes(reader, axes, sweep);
  read_fixed(reader, sweep.fixed);
  refuse_fixed_axes(reader, sweep);
  read_seeds(reader, sweep.seeds);
  read_estimators(reader, sweep);
}

SweepFile read_sweep_file(const std::filesystem::path& path) {
  const ConfigNode file = read_yaml_file(path);
  SweepFile sweep;
  sweep.name = path.stem().string();
  sweep.path = path;
  ConfigReader reader(file, "");
  const bool has_scenario = reader.read("scenario", sweep.scenario);
  read_runs(reader, sweep);
  read_limits(reader, sweep.limits);
  read_boundary(reader, sweep);
  read_detectors(reader, sweep);
  reader.finish();
  if (!has_scenario) fail_at(file, "scenario", "the scenario's file");
  return sweep;
}

}  // namespace plumbline
