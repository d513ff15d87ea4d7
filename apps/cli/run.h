// The whole program but for its process: what main() and the tests call.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace lumirank::cli {

struct Streams {
  std::FILE* out;  // results
  std::FILE* err;  // progress, warnings and errors
};

// Results that standard output did not take.
struct OutputLost {
  int reason = 0;  // errno
};
// Prints results, or throws OutputLost.
void print(Streams streams, const std::string& text);

// Runs one command line, without the program's own name, and returns the exit code: 0 done, 1 internal error,
// 2 bad input, 130 interrupted. The streams are flushed, and stay open.
int run(const std::vector<std::string>& arguments, Streams streams);

}  // namespace lumirank::cli
