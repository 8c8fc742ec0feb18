#include "tools/thesis/page.h"

#include <algorithm>

#include "tools/evaluation/quantile.h"
#include "tools/report/markup.h"
#include "tools/report/page_style.h"
#include "tools/report/point_chart.h"

namespace plumbline {
namespace {

std::string badge(const std::optional<bool>& holds) {
  if (!holds) return "<span class=\"badge\">open</span>";
  return *holds ? "<span class=\"badge ok\">holds</span>" : "<span class=\"badge error\">does not hold</span>";
}

std::string cell(const std::string& text) { return "<td>" + escape_markup(text) + "</td>"; }

std::string tile(const std::string& name, std::size_t count) {
  return "<div class=\"tile\"><span>" + escape_markup(name) + "</span><b>" + std::to_string(count) + "</b></div>";
}

std::string tiles(const std::vector<RowResult>& rows) {
  const auto count = [&](const std::optional<bool>& verdict) {
    return static_cast<std::size_t>(
        std::count_if(rows.begin(), rows.end(), [&](const RowResult& row) { return row.judgement.holds == verdict; }));
  };
  return "<div class=\"tiles\">" + tile("Claims", rows.size()) + tile("Hold", count(true)) +
         tile("Do not hold", count(false)) + tile("Open", count(std::nullopt)) + "</div>";
}

std::string table(const std::vector<RowResult>& rows) {
  std::string html =
      "<div class=\"card scroll wide claims\"><table><tr><th>claim</th><th>thesis</th><th>ours, median</th><th>spread "
      "over "
      "seeds</th><th>seeds</th><th></th></tr>";
  for (const RowResult& row : rows) {
    const Judgement& judgement = row.judgement;
    const std::string claim = escape_markup(row.claim);
    html += "<tr><td>" +
            (row.version.empty() ? claim : "<a href=\"#" + escape_markup(row.id) + "\">" + claim + "</a>") + "</td>" +
            cell(row.thesis) + cell(judgement.ours) + cell(judgement.spread) +
            cell(row.version.empty() ? "" : std::to_string(judgement.seeds)) + "<td>" + badge(judgement.holds) +
            "</td></tr>";
  }
  return html + "</table></div>";
}

/// Each configuration's median, from the smallest to the largest value.
std::string spread_chart(const RowResult& row) {
  PointChart chart;
  chart.caption = "Median and range over the seeds";
  chart.joined = false;
  PointChart::Series series{"", "c0", {}};
  for (const ConfigurationFigures& of : row.judgement.figures) {
    const auto place = static_cast<double>(chart.ticks.size());
    chart.ticks.push_back({place, of.configuration});
    if (of.values.empty()) continue;
    const auto [low, high] = std::minmax_element(of.values.begin(), of.values.end());
    series.points.push_back({place, {*quantile(of.values, 0.5), *low, *high}});
  }
  if (series.points.empty()) return {};
  chart.series.push_back(std::move(series));
  Drawing drawing = point_chart(chart);
  drawing.legend.clear();
  return figure_html(drawing);
}

std::string checks(const RowResult& row) {
  std::string html = "<div class=\"card scroll\"><table><tr><th>check</th><th>measured</th><th></th></tr>";
  for (const CheckOutcome& check : row.judgement.checks) {
    html += "<tr>" + cell(check.check) + cell(check.measured) + "<td>" + badge(check.holds) + "</td></tr>";
  }
  return html + "</table></div>";
}

std::string links_of(const RowResult& row, const RunLinks& links) {
  const auto found = links.find(row.id);
  if (found == links.end()) return {};
  std::string html;
  for (const auto& [label, address] : found->second) {
    html +=
        (html.empty() ? "" : ", ") + ("<a href=\"" + escape_markup(address) + "\">" + escape_markup(label) + "</a>");
  }
  return "<p class=\"note\">Runs: " + html + "</p>";
}

std::string section(const RowResult& row, const RunLinks& links) {
  std::string note = "Thesis: " + row.thesis + ". Program " + row.version + ".";
  if (!row.judgement.note.empty()) note += " " + row.judgement.note + ".";
  return "<h2 id=\"" + escape_markup(row.id) + "\">" + escape_markup(row.claim) + " " + badge(row.judgement.holds) +
         "</h2><p class=\"note\">" + escape_markup(note) + "</p>" + links_of(row, links) + "<div class=\"pair\">" +
         spread_chart(row) + checks(row) + "</div>";
}

std::string open_rows(const std::vector<RowResult>& rows) {
  std::string html;
  for (const RowResult& row : rows) {
    if (!row.version.empty() || row.judgement.note.empty()) continue;
    html += "<tr>" + cell(row.claim) + cell(row.judgement.note) + "</tr>";
  }
  if (html.empty()) return {};
  return "<h2>Not to be run yet</h2><div class=\"card scroll\"><table>" + html + "</table></div>";
}

}  // namespace

std::string thesis_page(const std::vector<RowResult>& rows, const RunLinks& links) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>The thesis's claims – "
      "Plumbline</title><style>" +
      std::string(kPageStyle) +
      "</style></head><body><main><header><h1>The thesis's claims</h1><span class=\"sub\">Ji Zhang, Online Lidar and "
      "Vision based Ego-motion Estimation and Mapping, 2017</span></header>" +
      tiles(rows) + "<p class=\"note\"></p>" + table(rows);
  for (const RowResult& row : rows) {
    if (!row.version.empty()) html += section(row, links);
  }
  return html + open_rows(rows) + "</main></body></html>\n";
}

}  // namespace plumbline
