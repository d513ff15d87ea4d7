// The terminal: warnings, and a progress bar with the remaining time.
#pragma once

#include <cstdio>
#include <mutex>
#include <string>

#include "lumirank/sinks.h"

namespace lumirank::cli {

enum class Verbosity { quiet, normal, verbose };

class Console {
 public:
  Console(Verbosity verbosity, std::FILE* stream);
  ~Console();
  Sinks sinks();
  // Removes the bar, so that other text can be printed.
  void clear();

 private:
  void draw(const char* phase, double fraction);

  Verbosity verbosity_;
  std::FILE* stream_;
  bool terminal_;
  std::mutex mutex_;
  std::string phase_;
  double phase_start_ = 0, last_draw_ = 0, furthest_ = 0;
  bool drawn_ = false;
};

}  // namespace lumirank::cli
