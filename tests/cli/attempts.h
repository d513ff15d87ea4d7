// Attempts to break the program by its command line: what each must answer, and what it may leave behind.
#pragma once

#include <string>
#include <vector>

namespace lumirank::test {

struct Attempt {
  // Words parted by spaces; "@" is the attempt's folder, "''" an empty word, "~" a space within a word.
  std::string line;
  int code = 2;
  std::string says;         // in standard error, or in standard output where the code is 0
  std::string leaves = {};  // new files and folders, sorted, parted by spaces
};

// attempts_on_outputs.cpp, attempts_on_options.cpp
std::vector<Attempt> attempts_on_outputs();
std::vector<Attempt> attempts_on_options();

}  // namespace lumirank::test
