// Numbers and words out of a text buffer, fast and without ever reading past its end. Independent of the
// locale.
#pragma once

#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace lumirank::scenedesc {

// The text forms of infinity and NaN are read as what they say: callers check for finite values.
template <typename Real>
bool parse_float(const char*& p, const char* end, Real& value) {
  const char* first = p;
  if (first != end && *first == '+') ++first;
  const auto [next, status] = std::from_chars(first, end, value);
  if (status == std::errc::invalid_argument) return false;
  if (status == std::errc::result_out_of_range) {
    // Too small becomes 0, too large infinity.
    const std::string_view token(first, static_cast<std::size_t>(next - first));
    const std::size_t exponent = token.find_first_of("eE");
    const std::string_view digits = token.substr(0, exponent);
    const bool tiny = exponent != std::string_view::npos
                          ? token.find('-', exponent) != std::string_view::npos
                          : digits.find_first_of("123456789") > digits.find('.');
    value = tiny ? Real{0} : std::numeric_limits<Real>::infinity();
  }
  p = next;
  return true;
}

inline bool parse_integer(const char*& p, const char* end, std::int64_t& value) {
  const char* first = p;
  if (first != end && *first == '+') ++first;
  const auto [next, status] = std::from_chars(first, end, value);
  if (status != std::errc{}) return false;
  p = next;
  return true;
}

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

inline void skip_blanks(const char*& p, const char* end) {
  while (p != end && is_blank(*p)) ++p;
}

inline std::string_view take_word(const char*& p, const char* end) {
  skip_blanks(p, end);
  const char* first = p;
  while (p != end && !is_blank(*p) && *p != '\n') ++p;
  return {first, static_cast<std::size_t>(p - first)};
}

// A word for a message: in quotes, short, and without bytes that would upset a terminal.
inline std::string quoted_word(std::string_view word) {
  std::string out(1, '\'');
  for (const char c : word.substr(0, 24)) out += c < 0x20 || c > 0x7e ? '?' : c;
  out += word.size() > 24 ? "...'" : "'";
  return out;
}

}  // namespace lumirank::scenedesc
