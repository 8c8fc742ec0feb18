#include "tools/study/baseline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "scenarios/config_reader.h"
#include "scenarios/input_error.h"
#include "tools/formats/number_text.h"
#include "tools/study/suite_plan.h"

namespace plumbline {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::uintmax_t kLargestFile = 64'000'000;
constexpr std::size_t kMostRuns = 100'000;
constexpr std::size_t kMostSeconds = 100'000;
constexpr std::size_t kLongestText = 4096;
constexpr double kLargestNumber = 1e9;
constexpr int kDigits = 5;

ordered_json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  std::string text;
  append_general(text, value, kDigits);
  return ordered_json::parse(text);
}

ordered_json number(const std::optional<double>& value) { return value ? number(*value) : ordered_json(nullptr); }

/// In thousandths of the values' unit.
ordered_json thousandths(const std::vector<double>& values) {
  ordered_json list = ordered_json::array();
  for (const double value : values) list.push_back(number(1e3 * value));
  return list;
}

ordered_json run_json(const MeasuredRun& run) {
  return {{"scenario", run.scenario},
          {"seed", run.seed},
          {"status", run.status},
          {"drift_percent", number(run.drift_percent)},
          {"progress_ratio", number(run.progress_ratio)},
          {"estimator_time_ratio", number(run.estimator_time_ratio)},
          {"cpu_s", number(run.cpu_s)},
          {"peak_memory_mb", number(run.peak_memory_mb)},
          {"relative_error_by_second_mm", thousandths(run.relative_error_by_second_m)},
          {"relative_rotation_by_second_mdeg", thousandths(run.relative_rotation_by_second_deg)}};
}

std::string dump(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

/// Reads one object of the file, naming what is wrong with it.
class Reader {
 public:
  Reader(const json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object_.is_object()) fail("", "an object");
  }

  const json& at(const std::string& key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) throw InputError(where_ + "." + key + ": missing");
    return *found;
  }
  std::string text(const std::string& key) const {
    const json& value = at(key);
    if (!value.is_string() || value.get_ref<const std::string&>().size() > kLongestText) fail(key, "a short text");
    return value.get<std::string>();
  }
  std::uint64_t count(const std::string& key) const {
    const json& value = at(key);
    if (!value.is_number_unsigned()) fail(key, "a whole number from 0");
    return value.get<std::uint64_t>();
  }
  std::optional<double> figure(const std::string& key, double least = 0.0) const {
    return number_of(at(key), key, least);
  }
  double positive(const std::string& key) const {
    const auto value = figure(key);
    if (!value) fail(key, "a number");
    return *value;
  }
  std::vector<double> thousandths(const std::string& key) const {
    const json& list = at(key);
    if (!list.is_array() || list.size() > kMostSeconds) fail(key, "a list of at most 100000 numbers");
    std::vector<double> values;
    for (const json& value : list) {
      values.push_back(1e-3 * number_of(value, key, 0.0).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    return values;
  }
  [[noreturn]] void fail(const std::string& key, const std::string& expected) const {
    const json& found = key.empty() ? object_ : at(key);
    std::string shown = found.dump(-1, ' ', true, json::error_handler_t::replace);
    if (shown.size() > 40) shown = shown.substr(0, 37) + "...";
    throw InputError(where_ + (key.empty() ? "" : "." + key) + ": found " + shown + ", expected " + expected);
  }

 private:
  std::optional<double> number_of(const json& value, const std::string& key, double least) const {
    if (value.is_null()) return std::nullopt;
    if (!value.is_number()) fail(key, "numbers or null");
    const auto figure = value.get<double>();
    if (!(figure >= least && figure <= kLargestNumber)) {
      fail(key, "numbers from " + readable_text(least) + " to " + readable_text(kLargestNumber));
    }
    return figure;
  }

  const json& object_;
  std::string where_;
};

MeasuredRun run_of(const Reader& reader) {
  static const std::array<std::string, 4> kStatuses{"ok", "failed", "lost", "error"};
  MeasuredRun run;
  run.scenario = reader.text("scenario");
  run.seed = reader.count("seed");
  run.status = reader.text("status");
  if (std::find(kStatuses.begin(), kStatuses.end(), run.status) == kStatuses.end()) {
    reader.fail("status", "ok, failed, lost or error");
  }
  run.drift_percent = reader.figure("drift_percent");
  run.progress_ratio = reader.figure("progress_ratio", -kLargestNumber);
  run.estimator_time_ratio = reader.figure("estimator_time_ratio");
  run.cpu_s = reader.positive("cpu_s");
  run.peak_memory_mb = reader.positive("peak_memory_mb");
  run.relative_error_by_second_m = reader.thousandths("relative_error_by_second_mm");
  run.relative_rotation_by_second_deg = reader.thousandths("relative_rotation_by_second_mdeg");
  return run;
}

std::string content_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path.string() + ": baseline cannot be read: " + error.message());
  if (size > kLargestFile) throw InputError(path.string() + ": too large for a baseline (64 MB at most)");
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InputError(path.string() + ": baseline cannot be read");
  return text;
}

}  // namespace

Baseline baseline_of(const SuiteFile& suite, const SweepPlan& plan, const std::vector<StoredRun>& stored) {
  Baseline baseline{suite.name, suite_digest(suite), {}, plan.program, this_machine(), {}};
  for (const std::string& estimator : plan.estimators) {
    baseline.estimator += (baseline.estimator.empty() ? "" : ", ") + estimator;
  }
  baseline.runs = measured_runs(plan, stored);
  return baseline;
}

std::string baseline_json(const Baseline& baseline) {
  ordered_json head{
      {"schema_version", kBaselineSchemaVersion},
      {"suite", baseline.suite},
      {"suite_digest", baseline.suite_digest},
      {"estimator", baseline.estimator},
      {"program", baseline.program},
      {"machine", {{"cpu", baseline.machine.cpu}, {"cores", baseline.machine.cores}, {"os", baseline.machine.os}}}};
  std::string text = "{\n";
  for (const auto& [key, value] : head.items()) text += dump(key) + ": " + dump(value) + ",\n";
  text += "\"runs\": [";
  for (std::size_t i = 0; i < baseline.runs.size(); ++i)
    text += (i > 0 ? ",\n" : "\n") + dump(run_json(baseline.runs[i]));
  return text + "\n]\n}\n";
}

Baseline read_baseline(const std::filesystem::path& path) {
  const json parsed = json::parse(content_of(path), nullptr, /*allow_exceptions=*/false);
  const std::string where = path.string();
  if (parsed.is_discarded()) throw InputError(where + ": no baseline: it is no JSON, or was cut short");
  const Reader reader(parsed, where);
  const std::uint64_t version = reader.count("schema_version");
  if (version != kBaselineSchemaVersion) {
    throw InputError(where + ": baseline of schema version " + std::to_string(version) + ", this program knows " +
                     std::to_string(kBaselineSchemaVersion) + "; --update makes it anew");
  }
  Baseline baseline;
  baseline.suite = reader.text("suite");
  baseline.suite_digest = reader.text("suite_digest");
  baseline.estimator = reader.text("estimator");
  baseline.program = reader.text("program");
  const Reader machine(reader.at("machine"), where + ".machine");
  baseline.machine = {machine.text("cpu"), static_cast<unsigned>(machine.count("cores")), machine.text("os")};
  const json& runs = reader.at("runs");
  if (!runs.is_array() || runs.empty() || runs.size() > kMostRuns) reader.fail("runs", "a list of 1 to 100000 runs");
  std::set<std::pair<std::string, std::uint64_t>> seen;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::string at = where + ".runs[" + std::to_string(i) + "]";
    baseline.runs.push_back(run_of(Reader(runs[i], at)));
    const MeasuredRun& run = baseline.runs.back();
    if (!seen.emplace(run.scenario, run.seed).second) {
      throw InputError(at + ": " + run.scenario + ", seed " + std::to_string(run.seed) + " stands there twice");
    }
  }
  std::sort(baseline.runs.begin(), baseline.runs.end(), before_in_suite);
  return baseline;
}

}  // namespace plumbline
