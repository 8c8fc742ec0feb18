#include "tools/report/page_parts.h"

#include "tools/report/markup.h"
#include "tools/report/page_style.h"

namespace plumbline {

std::string page_html(const std::string& title, const std::string& html) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>" +
         escape_markup(title) + " – Plumbline</title><style>" + kPageStyle + "</style></head><body><main>" + html +
         "</main></body></html>\n";
}

std::string heading(const std::string& title, const std::string& note) {
  return "<h2>" + escape_markup(title) + "</h2><p class=\"note\">" + escape_markup(note) + "</p>";
}

std::string tile(const std::string& name, const std::string& value, const std::string& unit) {
  return "<div class=\"tile\"><span>" + escape_markup(name) + "</span><b>" + escape_markup(value) +
         (unit.empty() ? "" : " <small>" + escape_markup(unit) + "</small>") + "</b></div>";
}

std::string text_cell(const std::string& text) { return "<td>" + escape_markup(text) + "</td>"; }

std::string number_cell(const std::string& text) { return "<td class=\"number\">" + escape_markup(text) + "</td>"; }

std::string head_row(const std::vector<std::string>& columns, const std::vector<std::string>& number_columns) {
  std::string html = "<tr>";
  for (const std::string& column : columns) html += "<th>" + escape_markup(column) + "</th>";
  for (const std::string& column : number_columns) html += "<th class=\"number\">" + escape_markup(column) + "</th>";
  return html + "</tr>";
}

std::string wide_table(const std::string& html) {
  return "<div class=\"card scroll wide\"><table>" + html + "</table></div>";
}

}  // namespace plumbline
