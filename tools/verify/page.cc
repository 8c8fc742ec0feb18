#include "tools/verify/page.h"

#include "tools/report/markup.h"
#include "tools/report/page_style.h"

namespace plumbline {
namespace {

std::string table_of(const std::vector<VerifyRow>& rows) {
  std::string html =
      "<div class=\"card scroll\"><table><tr><th>check</th><th>bound</th><th>measured</th><th>holds</th></tr>";
  for (const VerifyRow& row : rows) {
    html += "<tr><td>" + escape_markup(row.check) + "</td><td>" + escape_markup(row.bound) + "</td><td>" +
            escape_markup(row.measured) + "</td><td><span class=\"badge " + (row.holds ? "ok\">yes" : "error\">no") +
            "</span></td></tr>";
  }
  return html + "</table></div>";
}

std::string html_of(const VerifySection& section) {
  return "<h2>" + escape_markup(section.title) + "</h2><p class=\"note\">" + escape_markup(section.note) + "</p>" +
         table_of(section.rows) + section.charts;
}

}  // namespace

std::string verify_page(const std::vector<VerifySection>& sections) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">"
      "<title>Sensors – Plumbline</title><style>" +
      std::string(kPageStyle) +
      ".pair{margin-top:14px}</style></head><body><main><header><h1>Simulated sensors against their "
      "models</h1></header>";
  for (const VerifySection& section : sections) html += html_of(section);
  return html + "</main></body></html>\n";
}

}  // namespace plumbline
