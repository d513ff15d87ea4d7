// The words of a pbrt file: bare words, quoted strings, brackets; comments run from # to the end of the line.
#pragma once

#include <deque>
#include <string>
#include <string_view>

#include "base/error.h"

namespace lumirank::scenedesc::pbrt {

struct File {
  std::string name, text;
};

// A line of a file that outlives it.
struct Place {
  const std::string* file = nullptr;
  int line = 0;
  operator SourceLocation() const { return {file ? *file : std::string(), line}; }
};

struct Token {
  enum class Kind { word, text, open, close, end };
  Kind kind = Kind::end;
  std::string_view value;  // of a text: between its quotes
  int line = 1;
};

// `file` must outlive this and every token. Throws InputError for a string without an end and for bytes that
// no text holds.
class Tokens {
 public:
  explicit Tokens(const File& file);

  const Token& peek() const { return next_; }
  Token take();
  Place place(const Token& token) const { return {&file_.name, token.line}; }

 private:
  Token read();
  Token read_text();

  const File& file_;
  std::size_t at_ = 0;
  int line_ = 1;
  Token next_;
  std::deque<std::string> unescaped_;  // what tokens with escapes refer to
};

// For messages: at most 40 characters of what the file says, in quotes.
std::string in_quotes(std::string_view text);

}  // namespace lumirank::scenedesc::pbrt
