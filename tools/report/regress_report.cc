#include "tools/report/regress_report.h"

#include "tools/formats/number_text.h"
#include "tools/report/markup.h"
#include "tools/report/page_parts.h"
#include "tools/report/regress_charts.h"

namespace plumbline {
namespace {

std::string title_block(const Regression& regression) {
  const bool passes = regression.comparison.passes();
  return "<header><h1>" + escape_markup(regression.suite) + "</h1><span class=\"badge " +
         (passes ? "ok\">no regression" : "error\">regression") + "</span><span class=\"sub\">" +
         escape_markup(regression.after.estimator) + "</span></header>";
}

std::string tiles(const Regression& regression) {
  std::string html = "<div class=\"tiles\">";
  for (const Change& change : regression.comparison.changes) {
    if (!change.scenario.empty() || change.pairs == 0) continue;
    const std::string sign = change.percent.value > 0.0 ? "+" : "";
    html += tile(change.figure->title, sign + readable_text(change.percent.value),
                 "% to " + readable_text(change.after) + " " + change.figure->unit);
  }
  return html + "</div>";
}

std::string list_item(const std::string& css_class, const std::string& mark, const std::string& text) {
  return "<li class=\"" + css_class + "\">" + mark + " " + escape_markup(text) + "</li>";
}

std::string findings(const Regression& regression) {
  std::string items;
  for (const std::string& failure : failures(regression)) items += list_item("broken", "✗", failure);
  for (const std::string& improvement : improvements(regression)) items += list_item("held", "✓", improvement);
  for (const std::string& note : regression.notes) items += list_item("", "·", note);
  if (items.empty()) items = list_item("held", "✓", "Nothing became worse or better beyond what chance gives.");
  return "<ul class=\"checks\">" + items + "</ul>";
}

std::string verdict_badge(const Change& change) {
  if (!change.gated) return "<td><span class=\"badge\">only shown</span></td>";
  if (change.worse) return "<td><span class=\"badge error\">worse</span></td>";
  return change.better ? "<td><span class=\"badge ok\">better</span></td>" : "<td>no change</td>";
}

std::string change_table(const Regression& regression) {
  std::string html =
      head_row({"figure", "scenario", "verdict"}, {"before", "after", "growth (95 %)", "chance of so much",
                                                   "fails beyond", "detectable", "detectable, other seeds"});
  const auto& changes = regression.comparison.changes;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Change& change = changes[i];
    html += "<tr>" + text_cell(change.figure->title + ", " + change.figure->unit) +
            text_cell(change.scenario.empty() ? "all" : change.scenario) + verdict_badge(change) +
            number_cell(readable_text(change.before)) + number_cell(readable_text(change.after)) +
            number_cell(growth_text(change)) + number_cell(readable_text(change.p_worse)) +
            number_cell(readable_text(change.effect_percent) + " %") +
            number_cell(detectable_text(change.detectable_percent)) +
            number_cell(detectable_text(regression.unpaired_percent[i])) + "</tr>";
  }
  return wide_table(html);
}

std::string status_note(const Regression& regression) {
  const StatusChange& status = regression.comparison.status;
  return "<p class=\"note\">Status: " + std::to_string(status.newly_failing.size()) + " of " +
         std::to_string(regression.comparison.pairs.size()) + " runs that were ok are not, " +
         std::to_string(status.newly_ok.size()) + " became ok. It fails from " + std::to_string(status.least_failing) +
         " more runs on, if that is clear.</p>";
}

std::string badge_cell(const MeasuredRun& run) {
  return "<td><span class=\"badge " + escape_markup(run.status) + "\">" + escape_markup(run.status) + "</span></td>";
}

std::string both(const RegressFigure& figure, const RunPair& pair) {
  return number_cell(shown(figure.value(*pair.before)) + " → " + shown(figure.value(*pair.after)));
}

/// Runs of this regression have pages; those of the baseline had.
std::string run_table(const Regression& regression) {
  std::vector<std::string> figures;
  for (const RegressFigure& figure : regress_figures()) figures.push_back(figure.title + ", " + figure.unit);
  std::string html = head_row({"run", "before", "after"}, figures);
  for (const RunPair& pair : regression.comparison.pairs) {
    const std::string name = escape_markup(pair.after->scenario + ", seed " + std::to_string(pair.after->seed));
    const bool has_page = pair.after->status != "error";
    html += "<tr><td>" + (has_page ? "<a href=\"runs/" + pair.after->key + "/report.html\">" + name + "</a>" : name) +
            "</td>" + badge_cell(*pair.before) + badge_cell(*pair.after);
    for (const RegressFigure& figure : regress_figures()) html += both(figure, pair);
    html += "</tr>";
  }
  return "<details><summary>" + std::to_string(regression.comparison.pairs.size()) + " runs</summary>" +
         wide_table(html) + "</details>";
}

std::string origin_table(const Regression& regression) {
  std::string html = head_row({"", "before", "after"}, {});
  const auto add = [&](const char* name, const std::string& before, const std::string& after) {
    html += "<tr><th>" + std::string(name) + "</th>" + text_cell(before) + text_cell(after) + "</tr>";
  };
  const Baseline& before = regression.before;
  const Baseline& after = regression.after;
  add("Plumbline", before.program, after.program);
  add("Estimator", before.estimator, after.estimator);
  add("Processor", before.machine.cpu + ", " + std::to_string(before.machine.cores) + " cores",
      after.machine.cpu + ", " + std::to_string(after.machine.cores) + " cores");
  add("System", before.machine.os, after.machine.os);
  add("Suite", before.suite + ", " + before.suite_digest, after.suite + ", " + after.suite_digest);
  return "<div class=\"card\"><table>" + html + "</table></div>";
}

std::string chart_row(std::vector<Drawing> drawings, std::vector<Drawing>& all) {
  std::string html = "<div class=\"pair\">";
  for (Drawing& drawing : drawings) {
    html += figure_html(drawing);
    all.push_back(std::move(drawing));
  }
  return html + "</div>";
}

}  // namespace

RegressReport regress_report(const Regression& regression) {
  RegressReport report;
  const std::string growth = chart_row(growth_charts(regression), report.charts);
  const std::string before_after = chart_row(before_after_charts(regression), report.charts);
  report.html = page_html(
      regression.suite,
      title_block(regression) + tiles(regression) + findings(regression) +
          heading(
              "Changes",
              "Every run against the same scenario and seed before. A change fails only if it is larger than the "
              "effect stated and clear by a paired bootstrap over runs; all tests together raise a false alarm in at "
              "most " +
                  readable_text(100.0 * kFalseAlarmRate) +
                  " % of comparisons (Holm). Detectable is the growth that is caught 19 times in 20: with runs "
                  "paired as these are, and as if before and after had other seeds, which is the worst case of two "
                  "machines that round differently.") +
          change_table(regression) + status_note(regression) +
          heading("Growth by scenario", "Averages of ratios, run by run; 95 % intervals.") + growth +
          heading("Before and after", "Medians over the seeds with 95 % bootstrap intervals.") + before_after +
          heading("1 s relative error along the way",
                  "Root mean square over the seeds of the motions that begin then.") +
          "<div class=\"pair\">" + error_over_time_charts(regression) + "</div>" +
          heading("Runs", "Each leads to its own page. The suite as a sweep: report.html.") + run_table(regression) +
          heading("How it was made", "What stands on either side.") + origin_table(regression));
  return report;
}

}  // namespace plumbline
