#pragma once

#include <string>
#include <utility>
#include <vector>

namespace plumbline {

/// A chart that goes into a page and into a file of its own.
struct Drawing {
  std::string name;  ///< of its file, without ending
  std::string caption;
  std::string unit;                                         ///< written after the caption
  std::vector<std::pair<std::string, std::string>> legend;  ///< (CSS class, label)
  double width = 560.0;
  double height = 240.0;
  std::string body;  ///< SVG elements, coloured through the page's CSS classes
};

/// A figure of the page.
std::string figure_html(const Drawing& drawing);

/// A whole SVG document that brings caption, legend and style with it.
std::string svg_document(const Drawing& drawing);

}  // namespace plumbline
