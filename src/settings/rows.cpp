#include "settings/rows.h"

#include <algorithm>

namespace lumirank::settings {

std::string format_number(double v) {
  char buffer[32];
  const auto [end, code] = std::to_chars(buffer, buffer + sizeof buffer, v);
  return code == std::errc{} ? std::string(buffer, end) : std::string{};
}

std::vector<std::string> split_settings(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace lumirank::settings
