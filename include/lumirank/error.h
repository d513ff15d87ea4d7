// The two kinds of failure: bad input (expected, exit code 2) and a broken invariant (a bug, exit code 1).
#pragma once

#include <stdexcept>
#include <string>

#include "lumirank/export.h"

namespace lumirank {

struct SourceLocation {
  std::string file;  // empty: not from a file (the command line, say)
  int line = 0;      // 1-based; 0: unknown or a binary file

  friend bool operator==(const SourceLocation&, const SourceLocation&) = default;
};

// "file:line", "file" or "".
LUMIRANK_API std::string to_string(const SourceLocation& where);

// The input or an option is wrong. what() reads "file:line: message; remedy".
class LUMIRANK_API InputError : public std::runtime_error {
 public:
  InputError(SourceLocation where, const std::string& message, const std::string& remedy = {});
  explicit InputError(const std::string& message, const std::string& remedy = {})
      : InputError(SourceLocation{}, message, remedy) {}

  const SourceLocation& where() const { return where_; }

 private:
  SourceLocation where_;
};

// An invariant of the program is broken: a bug. The message says how to replay the row or column.
class LUMIRANK_API InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

// The caller asked to stop (Ctrl-C).
class LUMIRANK_API Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace lumirank
