// Text for HTML, SVG and their attributes, and numbers for people.
#pragma once

#include <string>
#include <string_view>

namespace lumirank::pages {

// & < > " ' as entities; control characters that XML forbids become U+FFFD.
std::string escape_html(std::string_view text);
// A relative file name as a URL: all but unreserved characters and '/' percent-encoded.
std::string escape_url(std::string_view path);

std::string show_number(double value);   // three significant digits
std::string show_count(double value);    // 1.23 M, 456 k, 789
std::string show_percent(double value);  // of a ratio: 0.0123 → 1.23 %
std::string show_seconds(double value);

}  // namespace lumirank::pages
