#include "pages/html_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace lumirank::pages {

std::string escape_html(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      case '\n':
      case '\t':
        out += c;
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
          out += "\xef\xbf\xbd";
        } else {
          out += c;
        }
    }
  }
  return out;
}

std::string escape_url(std::string_view path) {
  std::string out;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') ||
                       (byte >= '0' && byte <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    if (plain) {
      out += c;
    } else {
      char code[4];
      std::snprintf(code, sizeof code, "%%%02X", byte);
      out += code;
    }
  }
  return out;
}

std::string show_number(double value) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  char text[64];
  // The exponent after rounding: 0.9996 has that of 1.00.
  std::snprintf(text, sizeof text, "%.2e", value);
  const int exponent = std::atoi(std::strchr(text, 'e') + 1);
  if (exponent >= -4 && exponent <= 6)
    std::snprintf(text, sizeof text, "%.*f", std::max(0, 2 - exponent), value);
  return text;
}

std::string show_count(double value) {
  if (!std::isfinite(value)) return "–";
  const char* const units[] = {"", " k", " M", " G", " T", " P"};
  int unit = 0;
  // 999.5 would be shown as 1000.
  while (std::abs(value) >= 999.5 && unit < 5) value /= 1000, ++unit;
  if (unit == 0 && value == std::floor(value)) return std::to_string(static_cast<long long>(value));
  return show_number(value) + units[unit];
}

std::string show_percent(double value) {
  return std::isfinite(value) ? show_number(100 * value) + " %" : show_number(value);
}

std::string show_seconds(double value) { return std::isfinite(value) ? show_number(value) + " s" : "–"; }

}  // namespace lumirank::pages
