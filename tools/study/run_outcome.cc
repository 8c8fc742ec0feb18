#include "tools/study/run_outcome.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scenarios/input_error.h"
#include "tools/exit_code.h"
#include "tools/formats/number_text.h"

namespace plumbline {
namespace {

using nlohmann::json;

std::string text_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Null unless the text is a whole object.
json parsed_result(const std::string& text) {
  json result = json::parse(text, nullptr, /*allow_exceptions=*/false);
  return result.is_object() ? result : json();
}

bool says(const std::string& output, int error) { return output.find(std::strerror(error)) != std::string::npos; }

void refuse_full_disk(const ChildEnd& end) {
  for (const int error : {ENOSPC, EDQUOT, EROFS}) {
    if (says(end.output, error)) {
      throw InputError(std::string("a run could not be written: ") + std::strerror(error) +
                       "; what has finished is kept, --resume goes on");
    }
  }
}

/// The program's own message, its last line.
std::string last_line(std::string output) {
  while (!output.empty() && (output.back() == '\n' || output.back() == ' ')) output.pop_back();
  const auto start = output.find_last_of("\n\r");
  return start == std::string::npos ? output : output.substr(start + 1);
}

std::string number(double value) { return readable_text(value); }

void explain(const ChildEnd& end, const RunLimits& limits, StoredRun& run) {
  switch (end.kind) {
    case ChildEnd::Kind::kTimeLimit:
      run.outcome = "time_limit";
      run.reason = "ran longer than its limit of " + number(limits.time_s) + " s";
      return;
    case ChildEnd::Kind::kMemoryLimit:
      run.outcome = "memory_limit";
      run.reason = "took more memory than its limit of " + number(limits.memory_mb) + " MB";
      return;
    case ChildEnd::Kind::kSignalled:
      run.outcome = "crashed";
      run.reason = "killed by signal " + std::to_string(end.code) + " (" + strsignal(end.code) + ")";
      return;
    case ChildEnd::Kind::kExited:
      run.outcome = end.code == kExitBadInput ? "refused" : "crashed";
      run.reason = last_line(end.output);
      if (run.reason.empty()) run.reason = "ended with exit code " + std::to_string(end.code) + " and no result";
      return;
  }
}

std::string bounds_text(const json& check) {
  std::string text;
  for (const char* bound : {"min", "max"}) {
    if (!check.value(bound, json()).is_number()) continue;
    if (!text.empty()) text += " and ";
    text += std::string(bound[1] == 'i' ? "at least " : "at most ") + number(check[bound].get<double>());
  }
  return text;
}

std::string broken_checks(const json& result) {
  std::string text;
  for (const json& check : result.value("checks", json::array())) {
    if (check.value("holds", true)) continue;
    text += (text.empty() ? "" : "; ") + check.value("key", "") + ": expected " + bounds_text(check);
  }
  return text.empty() ? "an expectation did not hold" : text;
}

}  // namespace

std::string reason_in_result(const std::string& text) {
  const json result = parsed_result(text);
  if (result.is_null()) return {};
  const std::string status = result.value("status", "error");
  if (status == "ok") return {};
  if (status == "failed") return broken_checks(result);
  if (status == "lost") {
    const json since = result.value("lost_since_s", json());
    return since.is_number() ? "position error beyond 1 m + 10 % since " + number(since.get<double>()) + " s"
                             : "the estimator says that it is lost";
  }
  const json fault = result.value("fault", json());
  return fault.is_string() ? fault.get<std::string>() : "an unexplained fault";
}

std::optional<StoredRun> outcome_of(const PlannedRun& run, const ChildEnd& end, const RunLimits& limits,
                                    const std::filesystem::path& run_directory) {
  StoredRun stored;
  stored.key = run.key;
  stored.wall_s = end.wall_s;
  stored.cpu_s = end.cpu_s;
  stored.peak_memory_mb = end.peak_memory_mb;
  const bool stopped_by_us = end.kind != ChildEnd::Kind::kExited;
  if (!stopped_by_us && end.code == kExitInterrupted) return std::nullopt;
  const std::string result = text_of_file(run_directory / "result.json");
  if (!parsed_result(result).is_null()) {
    stored.outcome = "finished";
    stored.result = result;
    stored.reason = reason_in_result(result);
    return stored;
  }
  if (!stopped_by_us) refuse_full_disk(end);
  explain(end, limits, stored);
  stored.output = end.output;
  return stored;
}

std::optional<StoredRun> found_outcome(const PlannedRun& run, const std::string& program,
                                       const std::filesystem::path& run_directory) {
  const std::string text = text_of_file(run_directory / "result.json");
  const json result = parsed_result(text);
  if (result.is_null() || !result.contains("provenance")) return std::nullopt;
  const json& provenance = result["provenance"];
  const json commit = provenance.value("git_commit", json());
  const std::string made_by =
      provenance.value("version", "") + (commit.is_string() ? " (" + commit.get<std::string>() + ")" : "");
  if (made_by != program || provenance.value("scenario_digest", "") != run.scenario_digest ||
      provenance.value("seed", std::uint64_t{0}) != run.seed || provenance.value("estimator", "") != run.estimator) {
    return std::nullopt;
  }
  StoredRun stored;
  stored.key = run.key;
  stored.outcome = "finished";
  stored.result = text;
  stored.reason = reason_in_result(text);
  const json wall_s = result.value("wall_s", json());
  if (wall_s.is_number()) stored.wall_s = wall_s.get<double>();
  return stored;
}

}  // namespace plumbline
