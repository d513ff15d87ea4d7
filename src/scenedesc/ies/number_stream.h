// The numbers of a text, one after the other, separated by blanks, line ends and commas. Internal to this
// folder.
#pragma once

#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "base/error.h"

namespace lumirank::scenedesc {

class NumberStream {
 public:
  // `text` must outlive the stream. `line`: of its first character.
  NumberStream(std::string_view text, std::string filename, int line)
      : text_(text), filename_(std::move(filename)), line_(line) {}

  // `what` names the number in messages.
  float number(const std::string& what) {
    skip();
    if (at_ >= text_.size()) fail("the file ends where " + what + " should be");
    const std::string_view token = this->token();
    const char* first = token.data() + (token.front() == '+' ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(first, token.data() + token.size(), value);
    if (error != std::errc() || end != token.data() + token.size())
      fail(what + " is \"" + shortened(token) + "\", which is no number");
    if (!std::isfinite(value) || std::abs(value) > std::numeric_limits<float>::max())
      fail(what + " is not finite");
    at_ += token.size();
    return static_cast<float>(value);
  }
  int count(const std::string& what, int min_value, int max_value) {
    const float value = number(what);
    if (!(value >= static_cast<float>(min_value) && value <= static_cast<float>(max_value)) ||
        value != std::floor(value))
      fail(what + " is not a whole number from " + std::to_string(min_value) + " to " +
           std::to_string(max_value));
    return static_cast<int>(value);
  }
  float positive(const std::string& what) {
    const float value = number(what);
    if (!(value > 0)) fail(what + " is not above 0");
    return value;
  }

  // Whether anything is left, and whether it begins like a number.
  bool at_end() {
    skip();
    return at_ >= text_.size();
  }
  bool at_number() {
    skip();
    return at_ < text_.size() && std::string_view("+-.0123456789").find(text_[at_]) != std::string_view::npos;
  }
  SourceLocation where() const { return {filename_, line_}; }
  std::size_t left() const { return text_.size() - at_; }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(where(), message, "repair the file or export it again");
  }

 private:
  // Ctrl-Z ends files of old systems.
  static bool blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == '\x1a';
  }
  void skip() {
    for (; at_ < text_.size() && blank(text_[at_]); ++at_)
      if (text_[at_] == '\n' || (text_[at_] == '\r' && (at_ + 1 >= text_.size() || text_[at_ + 1] != '\n')))
        ++line_;
  }
  std::string_view token() const {
    std::size_t end = at_;
    while (end < text_.size() && !blank(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }
  static std::string shortened(std::string_view token) {
    std::string out;
    for (const char c : token.substr(0, 20)) out += c >= ' ' && c <= '~' ? c : '?';
    return token.size() > 20 ? out + "..." : out;
  }

  std::string_view text_;
  std::string filename_;
  int line_;
  std::size_t at_ = 0;
};

}  // namespace lumirank::scenedesc
