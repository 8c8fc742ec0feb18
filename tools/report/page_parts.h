#pragma once

#include <string>
#include <vector>

/// What all pages are put together from. Texts are escaped here unless a parameter is called html.
namespace plumbline {

/// A whole page that needs nothing from outside.
std::string page_html(const std::string& title, const std::string& html);

std::string heading(const std::string& title, const std::string& note);

/// A figure in large letters.
std::string tile(const std::string& name, const std::string& value, const std::string& unit);

std::string text_cell(const std::string& text);
std::string number_cell(const std::string& text);
/// A table's first row; numbers stand right.
std::string head_row(const std::vector<std::string>& columns, const std::vector<std::string>& number_columns);
/// A table on a card that scrolls sideways where the page is narrow.
std::string wide_table(const std::string& html);

}  // namespace plumbline
