#include "tools/report/regress_text.h"

#include <algorithm>

#include "tools/formats/number_text.h"
#include "tools/report/markup.h"

namespace plumbline {
namespace {

struct Case {
  std::string name;
  std::string failure;  ///< empty: passed
  bool skipped = false;
  double cpu_s = 0.0;
};

/// XML has no way to write control characters at all.
std::string xml_text(const std::string& text) {
  std::string safe = escape_markup(text);
  std::erase_if(safe, [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t'; });
  return safe;
}

std::string test_suite(const std::string& name, const std::vector<Case>& cases) {
  const auto failed = std::count_if(cases.begin(), cases.end(), [](const Case& c) { return !c.failure.empty(); });
  const auto skipped = std::count_if(cases.begin(), cases.end(), [](const Case& c) { return c.skipped; });
  std::string xml = "  <testsuite name=\"" + xml_text(name) + "\" tests=\"" + std::to_string(cases.size()) +
                    "\" failures=\"" + std::to_string(failed) + "\" errors=\"0\" skipped=\"" + std::to_string(skipped) +
                    "\">\n";
  for (const Case& test : cases) {
    xml += "    <testcase classname=\"" + xml_text(name) + "\" name=\"" + xml_text(test.name) + "\" time=\"" +
           fixed_text(test.cpu_s, 3) + "\"";
    if (!test.failure.empty()) {
      xml += "><failure message=\"" + xml_text(test.failure) + "\"/></testcase>\n";
    } else {
      xml += test.skipped ? "><skipped/></testcase>\n" : "/>\n";
    }
  }
  return xml + "  </testsuite>\n";
}

Case case_of(const Change& change) {
  Case test{change.scenario.empty() ? "whole suite" : change.scenario, {}, !change.gated, 0.0};
  if (change.worse) {
    test.failure = change.figure->title + " grew by " + growth_text(change) + ", " + readable_text(change.before) +
                   " -> " + readable_text(change.after) + " " + change.figure->unit + "; allowed is " +
                   readable_text(change.effect_percent) + " % or what chance gives";
  }
  return test;
}

std::vector<Case> run_cases(const Comparison& comparison) {
  std::vector<Case> cases;
  for (const RunPair& pair : comparison.pairs) {
    Case test{pair.after->scenario + ", seed " + std::to_string(pair.after->seed), {}, false, pair.after->cpu_s};
    const bool broke = pair.before->status != "error" && pair.after->status == "error";
    if (broke) test.failure = "ends in an error: " + pair.after->reason;
    cases.push_back(std::move(test));
  }
  return cases;
}

/// A cell must not end itself, nor its row.
std::string cell(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::string safe;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '`') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string verdict_of(const Change& change) {
  if (!change.gated) return "only shown";
  if (change.worse) return "**worse**";
  return change.better ? "better" : "no change";
}

std::string table_row(const Change& change, double unpaired) {
  return "| " + cell(change.scenario.empty() ? change.figure->title : change.figure->title + ", " + change.scenario) +
         " | " + readable_text(change.before) + " | " + readable_text(change.after) + " " + change.figure->unit +
         " | " + growth_text(change) + " | " + verdict_of(change) + " | " + readable_text(change.effect_percent) +
         " % | " + detectable_text(change.detectable_percent) + " | " + detectable_text(unpaired) + " |\n";
}

}  // namespace

std::string regress_junit(const Regression& regression) {
  const Comparison& comparison = regression.comparison;
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"" + xml_text(regression.suite) + "\">\n";
  xml += test_suite(regression.suite + ".runs", run_cases(comparison));
  Case status{"whole suite", {}, false, 0.0};
  if (comparison.status.worse) {
    status.failure = std::to_string(comparison.status.newly_failing.size()) + " runs that were ok are not";
  }
  xml += test_suite(regression.suite + ".status", {status});
  for (const RegressFigure& figure : regress_figures()) {
    std::vector<Case> cases;
    for (const Change& change : comparison.changes) {
      if (change.figure->key == figure.key) cases.push_back(case_of(change));
    }
    xml += test_suite(regression.suite + "." + figure.key, cases);
  }
  return xml + "</testsuites>\n";
}

std::string regress_markdown(const Regression& regression) {
  const Comparison& comparison = regression.comparison;
  const bool passes = comparison.passes();
  std::string text = std::string("### ") + (passes ? "✅" : "❌") + " Plumbline: " + cell(regression.suite) +
                     (passes ? " shows no regression\n\n" : " shows a regression\n\n");
  for (const std::string& failure : failures(regression)) text += "- **" + cell(failure) + "**\n";
  for (const std::string& improvement : improvements(regression)) text += "- better: " + cell(improvement) + "\n";
  for (const std::string& note : regression.notes) text += "- note: " + cell(note) + "\n";
  const auto& changes = comparison.changes;
  const std::string head =
      "\n| figure | before | after | growth (95 %) | verdict | fails beyond | detectable | detectable, other seeds |\n"
      "| --- | ---: | ---: | ---: | --- | ---: | ---: | ---: |\n";
  text += head;
  std::string details = head;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    (changes[i].scenario.empty() ? text : details) += table_row(changes[i], regression.unpaired_percent[i]);
  }
  const StatusChange& status = comparison.status;
  text += "| Runs not ok any more | | " + std::to_string(status.newly_failing.size()) + " of " +
          std::to_string(comparison.pairs.size()) + " | | " + (status.worse ? "**worse**" : "no change") + " | " +
          std::to_string(status.least_failing - 1) + " runs | | |\n";
  text += "\n<details><summary>By scenario</summary>\n" + details + "\n</details>\n";
  return text + "\n" + std::to_string(comparison.pairs.size()) +
         " runs, each against the same scenario and seed. Before: " + cell(regression.before.program) + ", " +
         cell(regression.before.estimator) + "; after: " + cell(regression.after.program) + ", " +
         cell(regression.after.estimator) +
         ". A change fails only if it is larger than the effect stated and clear: all tests together raise a false "
         "alarm "
         "in at most " +
         readable_text(100.0 * kFalseAlarmRate) +
         " % of comparisons. \"Detectable\" is the growth that is caught 19 times in 20.\n";
}

}  // namespace plumbline
