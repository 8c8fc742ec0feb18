#pragma once

namespace plumbline {

/// The report's one style sheet: light and dark, desktop and phone, nothing from outside.
extern const char* const kPageStyle;

}  // namespace plumbline
